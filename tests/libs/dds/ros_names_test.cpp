// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/ros_names.hpp"

#include <gtest/gtest.h>

#include "libs/core/error.hpp"

namespace palpate::dds {
namespace {

TEST(RosNames, TopicsAndTypesAreMappedAsRos2MapsThem) {
  EXPECT_EQ(DdsTopicName("/robot/mesh_state"), "rt/robot/mesh_state");
  EXPECT_EQ(DdsTypeName("geometry_msgs/msg/WrenchStamped"),
            "geometry_msgs::msg::dds_::WrenchStamped_");
}

TEST(RosNames, RefusesWhatRos2WouldRefuse) {
  for (const char* name : {"", "forces", "/", "/a/", "//a", "/1a", "/a b", "/a__b", "/a/<name>"}) {
    EXPECT_FALSE(IsRosTopicName(name)) << name;
    EXPECT_THROW(DdsTopicName(name), InputError) << name;
  }
  for (const char* type : {"", "Force", "/msg/Force", "p/msg/", "p/srv/Force", "p/msg/F/G"}) {
    EXPECT_THROW(DdsTypeName(type), InputError) << type;
  }
}

TEST(RosNames, AnyTextBecomesOnePartOfAName) {
  for (const char* text : {"tip", "leg north", "1st", "", "a--b", "_", "grün"}) {
    EXPECT_TRUE(IsRosTopicName("/" + RosNamePart(text))) << text << " -> " << RosNamePart(text);
  }
  EXPECT_EQ(RosNamePart("tip_1"), "tip_1");
  EXPECT_EQ(RosNamePart("leg north"), "leg_north");
  EXPECT_EQ(RosNamePart("1st"), "_1st");
}

}  // namespace
}  // namespace palpate::dds
