// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <limits>

#include "components/virtual_camera/node/convert.hpp"
#include "libs/dds/geometry_messages.hpp"

namespace palpate::virtual_camera {
namespace {

using ::testing::HasSubstr;

dds::Message<idl::palpate_msgs::Mesh> OneTriangle() {
  Eigen::Matrix3Xd nodes_m(3, 3);
  nodes_m << 0, 1, 0, 0, 0, 1, 0, 0, 0;
  return dds::ToMesh({"robot", "hash", nodes_m, Eigen::MatrixXi(4, 0), Eigen::Vector3i(0, 1, 2)},
                     1);
}

scenario::Schedule TwoRecordings() {
  scenario::Scenario scenario;
  scenario.rest_between_s = 1.0;
  scenario.recordings.resize(2);
  scenario.recordings[0].duration_s = 4.0;
  return {scenario, {}};
}

dds::Message<idl::palpate_msgs::BenchState> SecondRecording() {
  dds::Message<idl::palpate_msgs::BenchState> message;
  dds::SetText(message->header.frame_id, "robot");
  message->recording = 1;
  message->t_s = 0.5;
  message->camera_in_robot = dds::ToPose(Eigen::Isometry3d::Identity());
  dds::Resize(message->tools, 1);
  dds::SetText(message->tools._buffer[0].name, "finger");
  message->tools._buffer[0].pose = dds::ToPose(Eigen::Isometry3d::Identity());
  return message;
}

TEST(MeshMessage, BecomesTheSkin) {
  RobotSurface skin;
  ASSERT_TRUE(FromMesh(*OneTriangle(), &skin).ok());
  EXPECT_EQ(skin.rest_m.cols(), 3);
  EXPECT_EQ(skin.rest_m(0, 1), 1.0);
  EXPECT_EQ(skin.triangles, Eigen::Vector3i(0, 1, 2));
}

TEST(MeshMessage, RefusesWhatIsNoSurface) {
  RobotSurface skin;
  const auto refusal = [&](const auto& message) {
    const Status status = FromMesh(*message, &skin);
    EXPECT_EQ(status.code(), StatusCode::kInvalidInput);
    return status.message();
  };
  auto far_node = OneTriangle();
  far_node->surface_triangles._buffer[2] = 3;
  EXPECT_THAT(refusal(far_node), HasSubstr("node 3 of 3"));
  auto odd = OneTriangle();
  odd->nodes_m._length = 8;
  EXPECT_THAT(refusal(odd), HasSubstr("8 coordinates"));
  auto nan = OneTriangle();
  nan->nodes_m._buffer[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(nan), HasSubstr("not finite"));
  auto frame = OneTriangle();
  dds::SetText(frame->header.frame_id, "world");
  EXPECT_THAT(refusal(frame), HasSubstr("'world'"));
}

TEST(MeshStateMessage, BecomesPositionsOfTheMeshItBelongsTo) {
  const Eigen::VectorXd x_m = Eigen::VectorXd::LinSpaced(9, 0.0, 0.8);
  View view;
  ASSERT_TRUE(FromMeshState(*dds::ToMeshState(x_m, "hash", 1), 3, &view).ok());
  EXPECT_NEAR(view.nodes_m(1, 2), 0.7, 1e-7);
}

TEST(MeshStateMessage, RefusesOtherNodesFailedStatesAndNaN) {
  const Eigen::VectorXd x_m = Eigen::VectorXd::Zero(9);
  View view;
  const auto refusal = [&](const auto& message, Eigen::Index nodes) {
    const Status status = FromMeshState(*message, nodes, &view);
    EXPECT_EQ(status.code(), StatusCode::kInvalidInput);
    return status.message();
  };
  EXPECT_THAT(refusal(dds::ToMeshState(x_m, "hash", 1), 4), HasSubstr("4 nodes"));
  auto failed = dds::ToMeshState(x_m, "hash", 1);
  dds::SetText(failed->status, "not_converged");
  EXPECT_THAT(refusal(failed, 3), HasSubstr("not_converged"));
  auto nan = dds::ToMeshState(x_m, "hash", 1);
  nan->positions_m._buffer[5] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(refusal(nan, 3), HasSubstr("not finite"));
}

TEST(BenchStateMessage, GivesToolsAndTheTimeOnTheBenchsClock) {
  View view;
  ASSERT_TRUE(FromBenchState(*SecondRecording(), TwoRecordings(), &view).ok());
  EXPECT_EQ(view.recording, 1);
  EXPECT_DOUBLE_EQ(view.t_s, 1.0 + 4.0 + 1.0 + 0.5);
  ASSERT_EQ(view.tools.size(), 1u);
  EXPECT_EQ(view.tools[0].tool, "finger");
}

TEST(BenchStateMessage, RefusesPosesAndRecordingsThatAreNone) {
  View view;
  const auto refusal = [&](const auto& message) {
    const Status status = FromBenchState(*message, TwoRecordings(), &view);
    EXPECT_EQ(status.code(), StatusCode::kInvalidInput);
    return status.message();
  };
  auto recording = SecondRecording();
  recording->recording = 2;
  EXPECT_THAT(refusal(recording), HasSubstr("recording 2 of 2"));
  auto tool = SecondRecording();
  tool->tools._buffer[0].pose.orientation.w = 0.0;
  EXPECT_THAT(refusal(tool), HasSubstr("finger"));
  auto camera = SecondRecording();
  camera->camera_in_robot.position.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(camera), HasSubstr("camera"));
}

}  // namespace
}  // namespace palpate::virtual_camera
