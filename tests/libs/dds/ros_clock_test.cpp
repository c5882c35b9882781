// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/ros_clock.hpp"

#include <gtest/gtest.h>

#include "libs/dds/health.hpp"
#include "libs/dds/stamp.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::dds {
namespace {

constexpr std::int64_t kTime_ns = 12'500'000'000;

Participant SimTimeNode() {
  ParticipantSettings settings{.domain_id = TestDomain(), .node_name = "sim_time_node"};
  settings.use_sim_time = true;
  return {settings, BuiltInTable()};
}

Message<idl::rosgraph_msgs::Clock> ClockAt(std::int64_t now_ns) {
  Message<idl::rosgraph_msgs::Clock> message;
  message->clock = TimeFromNs(now_ns);
  return message;
}

TEST(RosClock, WithoutSimTimeItIsTheSystemClock) {
  TestNode node("node");
  const std::int64_t before_ns = WallClockNs();
  const std::int64_t now_ns = node.participant.Now_ns();
  EXPECT_GE(now_ns, before_ns);
  EXPECT_LE(now_ns, WallClockNs());
  EXPECT_EQ(node.participant.clock()->reader(), nullptr);
}

TEST(RosClock, WithSimTimeItIsWhatTheClockTopicSaid) {
  Participant node = SimTimeNode();
  EXPECT_EQ(node.Now_ns(), 0);
  TestNode bag("bag");
  auto writer = bag.participant.CreateWriter(kClockTopic, bag.Waker());
  ASSERT_TRUE(bag.WaitFor([&] { return writer.matched() == 1; }));
  bag.loop.Every(std::chrono::milliseconds(5), [] {});
  ASSERT_TRUE(writer.Write(ClockAt(kTime_ns)));
  ASSERT_TRUE(bag.WaitFor([&] { return node.Now_ns() == kTime_ns; }));
  EXPECT_EQ(node.Now_ns(), kTime_ns);
  ASSERT_TRUE(writer.Write(ClockAt(1)));  // a recording that begins again
  EXPECT_TRUE(bag.WaitFor([&] { return node.Now_ns() == 1; }));
}

TEST(RosClock, AReliableClockIsReadToo) {
  Participant node = SimTimeNode();
  TestNode bag("bag", TableWith("/clock", [](TopicSettings& topic) {
                 topic.reliability = Reliability::kReliable;
               }));
  auto writer = bag.participant.CreateWriter(kClockTopic, bag.Waker());
  EXPECT_TRUE(bag.WaitFor([&] { return writer.matched() == 1; }));
}

TEST(RosClock, ReportsAreStampedWithIt) {
  Participant node = SimTimeNode();
  TestNode bag("bag");
  auto writer = bag.participant.CreateWriter(kClockTopic, bag.Waker());
  auto statuses = bag.participant.CreateReader(kComponentStatusTopic, bag.Waker());
  HealthReporter reporter(node, "thing", HealthReporter::Clock::now());
  ASSERT_TRUE(bag.WaitFor([&] { return writer.matched() == 1 && statuses.matched() == 1; }));
  bag.loop.Every(std::chrono::milliseconds(5), [] {});
  ASSERT_TRUE(writer.Write(ClockAt(kTime_ns)));
  ASSERT_TRUE(bag.WaitFor([&] { return node.Now_ns() == kTime_ns; }));
  std::int64_t stamp_ns = 0;
  bag.loop.Attach(statuses, [&] {
    for (const auto& status : statuses.Take()) stamp_ns = StampNs(status.header.stamp);
  });
  reporter.Report(Status::Ok(), {}, {}, HealthReporter::Clock::now());
  ASSERT_TRUE(bag.WaitFor([&] { return stamp_ns != 0; }));
  EXPECT_EQ(stamp_ns, kTime_ns);
}

}  // namespace
}  // namespace palpate::dds
