// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "components/view/node/convert_texts.hpp"
#include "libs/dds/message.hpp"

namespace palpate::view {
namespace {

nlohmann::json Told(const std::vector<std::string>& chambers) {
  dds::Message<idl::sensor_msgs::JointState> joints;
  dds::Resize(joints->name, 2);
  dds::SetText(joints->name._buffer[0], "north");
  dds::SetText(joints->name._buffer[1], "bend");
  const double position[] = {0.004, 2e-6}, effort[] = {1.5, 12e3};
  dds::SetNumbers(joints->position, position, 2);
  dds::SetNumbers(joints->effort, effort, 2);
  return nlohmann::json::parse(*CablesMessage(*joints, chambers).head);
}

TEST(ChamberMessages, ChambersOfTheRobotHaveVolumeAndPressure) {
  const nlohmann::json told = Told({"bend"});
  ASSERT_EQ(told.at("cables").size(), 1U);
  EXPECT_EQ(told.at("cables")[0].at("name"), "north");
  EXPECT_EQ(told.at("cables")[0].at("tension_N"), 1.5);
  ASSERT_EQ(told.at("chambers").size(), 1U);
  EXPECT_EQ(told.at("chambers")[0].at("name"), "bend");
  EXPECT_EQ(told.at("chambers")[0].at("volume_m3"), 2e-6);
  EXPECT_EQ(told.at("chambers")[0].at("pressure_Pa"), 12e3);
  EXPECT_FALSE(told.at("chambers")[0].contains("tension_N"));
}

TEST(ChamberMessages, WithoutARobotAllJointsAreCables) {
  const nlohmann::json told = Told({});
  EXPECT_EQ(told.at("cables").size(), 2U);
  EXPECT_TRUE(told.at("chambers").empty());
}

}  // namespace
}  // namespace palpate::view
