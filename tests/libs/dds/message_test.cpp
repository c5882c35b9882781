// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/message.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "libs/dds/gap_counter.hpp"
#include "libs/dds/stamp.hpp"
#include "sensor_msgs/msg/JointState.hpp"

namespace palpate::dds {
namespace {

TEST(Message, KeepsTextsAndNumbersWhenMoved) {
  Message<idl::sensor_msgs::JointState> first;
  SetText(first->header.frame_id, "robot");
  SetText(first->header.frame_id, "camera");
  const std::vector<double> numbers{1.5, -2.0};
  SetNumbers(first->position, numbers.data(), numbers.size());
  Resize(first->name, 1);
  SetText(first->name._buffer[0], "north");

  Message<idl::sensor_msgs::JointState> second = std::move(first);
  EXPECT_EQ(Text(second->header.frame_id), "camera");
  EXPECT_EQ(Text(second->name._buffer[0]), "north");
  std::vector<double> read;
  for (const double number : Elements(second->position)) read.push_back(number);
  EXPECT_EQ(read, numbers);
  EXPECT_EQ(second->velocity._length, 0u);
}

TEST(Message, AnUnsetTextIsEmpty) {
  Message<idl::sensor_msgs::JointState> message;
  EXPECT_EQ(Text(message->header.frame_id), "");
}

TEST(Stamp, NanosecondsSurviveThereAndBackOnBothSidesOfTheEpoch) {
  for (const int64_t stamp_ns : {int64_t{0}, int64_t{1}, int64_t{-1}, int64_t{999'999'999},
                                 int64_t{-1'000'000'000}, int64_t{1'700'000'000'123'456'789}}) {
    const auto time = TimeFromNs(stamp_ns);
    EXPECT_LT(time.nanosec, 1'000'000'000u);
    EXPECT_EQ(StampNs(time), stamp_ns);
  }
}

TEST(GapCounter, CountsWhatNeverCameAndTellsARestart) {
  using Order = GapCounter::Order;
  GapCounter gaps;
  EXPECT_EQ(gaps.Add(7), Order::kNewSequence);
  EXPECT_EQ(gaps.lost(), 0u);
  EXPECT_EQ(gaps.Add(8), Order::kNext);
  EXPECT_EQ(gaps.Add(8), Order::kRepeated);
  EXPECT_EQ(gaps.Add(11), Order::kNext);
  EXPECT_EQ(gaps.lost(), 2u);
  EXPECT_EQ(gaps.Add(0), Order::kNewSequence);
  EXPECT_EQ(gaps.lost(), 2u);
}

}  // namespace
}  // namespace palpate::dds
