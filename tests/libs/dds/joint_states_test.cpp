// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/joint_states.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "libs/dds/message.hpp"
#include "libs/dds/stamp.hpp"
#include "tests/support/not_a_number.hpp"

namespace palpate::dds {
namespace {

using ::testing::HasSubstr;

TEST(JointStates, ComeInTheRobotsOrderAndNanMeansNotKnown) {
  Message<idl::sensor_msgs::JointState> message;
  SetHeader(message->header, 7, "robot");
  Resize(message->name, 2);
  SetText(message->name._buffer[0], "south");
  SetText(message->name._buffer[1], "north");
  const std::vector<double> displacements_m{kNaN, 0.01}, tensions_N{3.0, kNaN};
  SetNumbers(message->position, displacements_m.data(), 2);
  SetNumbers(message->effort, tensions_N.data(), 2);
  CableReading reading;
  ASSERT_TRUE(FromJointState(*message, {"north", "east", "south"}, &reading).ok());
  EXPECT_EQ(reading.stamp_ns, 7);
  EXPECT_EQ(reading.cables[0].displacement_m, 0.01);
  EXPECT_EQ(reading.cables[0].tension_N, std::nullopt);
  EXPECT_EQ(reading.cables[1].displacement_m, std::nullopt);
  EXPECT_EQ(reading.cables[2].tension_N, 3.0);
  message->position._length = 0;
  ASSERT_TRUE(FromJointState(*message, {"north", "east", "south"}, &reading).ok());
  EXPECT_EQ(reading.cables[0].displacement_m, std::nullopt);
  EXPECT_EQ(reading.cables[2].tension_N, 3.0);
  message->position._length = 2;

  EXPECT_THAT(FromJointState(*message, {"north", "sout"}, &reading).message(),
              HasSubstr("unknown cable 'south' (did you mean 'sout'?)"));
  message->position._length = 1;
  EXPECT_THAT(FromJointState(*message, {"north", "south"}, &reading).message(),
              HasSubstr("2 names, 1 positions, 2 efforts"));
  message->position._length = 2;
  message->effort._length = 1;
  EXPECT_THAT(FromJointState(*message, {"north", "south"}, &reading).message(),
              HasSubstr("2 names, 2 positions, 1 efforts"));
}

TEST(JointStates, RefuseAnInfiniteInput) {
  Message<idl::sensor_msgs::JointState> message;
  Resize(message->name, 1);
  SetText(message->name._buffer[0], "north");
  const double infinite = std::numeric_limits<double>::infinity();
  SetNumbers(message->position, &infinite, 1);
  CableReading reading;
  EXPECT_THAT(FromJointState(*message, {"north"}, &reading).message(),
              HasSubstr("the input of cable 'north' is infinite"));
}

}  // namespace
}  // namespace palpate::dds
