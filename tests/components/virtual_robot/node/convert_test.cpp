// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "components/virtual_robot/node/convert.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/stamp.hpp"
#include "tests/support/not_a_number.hpp"

namespace palpate::virtual_robot {
namespace {

using ::testing::HasSubstr;

const std::vector<std::string> kCables = {"north", "west"};

dds::Message<idl::sensor_msgs::JointState> CommandOf(const std::vector<std::string>& names,
                                                     const std::vector<double>& positions) {
  dds::Message<idl::sensor_msgs::JointState> message;
  dds::Resize(message->name, names.size());
  for (size_t i = 0; i < names.size(); ++i) dds::SetText(message->name._buffer[i], names[i]);
  dds::SetNumbers(message->position, positions.data(), positions.size());
  return message;
}

TEST(CommandMessage, IsTakenInTheOrderOfTheRobotsCables) {
  Eigen::VectorXd commanded_m = Eigen::VectorXd::Constant(2, kNaN);
  ASSERT_TRUE(
      FromCommand(*CommandOf({"west", "north"}, {0.002, 0.001}), kCables, &commanded_m).ok());
  EXPECT_EQ(commanded_m, Eigen::Vector2d(0.001, 0.002));
}

TEST(CommandMessage, CablesThatAreNotNamedKeepTheirsAndNaNLetsGo) {
  Eigen::VectorXd commanded_m = Eigen::Vector2d(0.001, 0.002);
  ASSERT_TRUE(FromCommand(*CommandOf({"west"}, {kNaN}), kCables, &commanded_m).ok());
  EXPECT_EQ(commanded_m[0], 0.001);
  EXPECT_TRUE(std::isnan(commanded_m[1]));
}

TEST(CommandMessage, RefusesWhatDoesNotFitAndChangesNothing) {
  Eigen::VectorXd commanded_m = Eigen::Vector2d(0.001, 0.002);
  const auto refusal = [&](const auto& message) {
    const Status status = FromCommand(*message, kCables, &commanded_m);
    EXPECT_EQ(status.code(), StatusCode::kInvalidInput);
    EXPECT_EQ(commanded_m, Eigen::Vector2d(0.001, 0.002));
    return status.message();
  };
  EXPECT_THAT(refusal(CommandOf({"north", "wst"}, {0.003, 0.0})), HasSubstr("west"));
  EXPECT_THAT(refusal(CommandOf({"north", "west"}, {0.003})), HasSubstr("2 names"));
  EXPECT_THAT(refusal(CommandOf({"north"}, {std::numeric_limits<double>::infinity()})),
              HasSubstr("infinite"));
}

TEST(JointStateMessage, HoldsWhatTheDrivesSay) {
  const auto message = ToJointState(kCables, {{0.001, 2.0}, {0.003, 0.0}}, 1'500'000'000);
  EXPECT_EQ(dds::StampNs(message->header.stamp), 1'500'000'000);
  ASSERT_EQ(message->name._length, 2u);
  EXPECT_EQ(dds::Text(message->name._buffer[1]), "west");
  EXPECT_EQ(message->position._buffer[1], 0.003);
  EXPECT_EQ(message->effort._buffer[0], 2.0);
}

TEST(TrueForcesMessage, NamesPlaceAndForce) {
  TrueForce force{"finger", {0.1, 0.2, 0.3}, {0.0, 0.0, 0.1}, {0.0, 0.0, -0.5}};
  const auto message = ToForceArray({force}, "push", 7);
  EXPECT_EQ(dds::Text(message->recording), "push");
  EXPECT_EQ(dds::Text(message->status), "ok");
  ASSERT_EQ(message->forces._length, 1u);
  EXPECT_EQ(dds::Text(message->forces._buffer[0].name), "finger");
  EXPECT_EQ(message->forces._buffer[0].position_m.y, 0.2);
  EXPECT_EQ(message->forces._buffer[0].force_n.z, -0.5);
}

TEST(BenchStateMessage, SaysWhereScenarioToolsAndCameraAre) {
  BenchFacts facts{"abc", 9, {1, 2.5}, Eigen::Isometry3d::Identity()};
  facts.T_robot_camera.translation() = Eigen::Vector3d(0.0, -0.4, 0.2);
  ToolPose tool{"finger", Eigen::Isometry3d::Identity()};
  tool.T_robot_tool.translation() = Eigen::Vector3d(0.01, 0.02, 0.13);
  const auto message = ToBenchState(facts, {tool}, 7);
  EXPECT_EQ(dds::Text(message->scenario), "abc");
  EXPECT_EQ(message->seed, 9u);
  EXPECT_EQ(message->recording, 1u);
  EXPECT_EQ(message->t_s, 2.5);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  ASSERT_TRUE(dds::FromPose(message->camera_in_robot, &pose));
  EXPECT_TRUE(pose.isApprox(facts.T_robot_camera));
  ASSERT_EQ(message->tools._length, 1u);
  EXPECT_EQ(dds::Text(message->tools._buffer[0].name), "finger");
  EXPECT_EQ(message->tools._buffer[0].pose.position.z, 0.13);
}

}  // namespace
}  // namespace palpate::virtual_robot
