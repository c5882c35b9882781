// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/recording/ros_names.hpp"

#include <gtest/gtest.h>

namespace palpate::recording {
namespace {

TEST(RosNames, TopicsLoseThePrefixOfDds) {
  EXPECT_EQ(RosTopicName("rt/forces"), "/forces");
  EXPECT_EQ(RosTopicName("gripper"), "gripper");
}

TEST(RosNames, TypesAreNamedAsRos2DoesAndOthersStay) {
  EXPECT_EQ(RosTypeName("palpate_msgs::msg::dds_::ForceArray_"), "palpate_msgs/msg/ForceArray");
  EXPECT_EQ(RosTypeName("lab::Gripper"), "lab::Gripper");
  EXPECT_EQ(RosTypeName("sensor_msgs/msg/Image"), "sensor_msgs/msg/Image");
}

}  // namespace
}  // namespace palpate::recording
