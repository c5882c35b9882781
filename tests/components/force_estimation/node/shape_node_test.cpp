// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <chrono>
#include <limits>
#include <string>
#include <vector>

#include "components/force_estimation/node/make_pipeline.hpp"
#include "libs/core/error.hpp"
#include "libs/dds/transforms.hpp"
#include "libs/geometry/frames.hpp"
#include "tests/components/force_estimation/node/shape_node_fixture.hpp"

/// palpate-force-estimation from the robot's shape.
namespace palpate::force_estimation {
namespace {

using ::testing::HasSubstr;

TEST_F(ShapeNodeTest, AnswersAFrameUnderItsStampWithAgeAndLatency) {
  const std::int64_t stamp_ns = dds::WallClockNs() - 1'000'000'000;
  const Answer answer = Ask({.stamp_ns = stamp_ns, .points = 3});
  EXPECT_EQ(answer.status, "ok");
  EXPECT_EQ(answer.device, "Palpate-1");
  EXPECT_THAT(answer.force_z_N, ::testing::ElementsAre(3.0));
  EXPECT_GE(answer.age_s, 1.0);
  EXPECT_LT(answer.age_s, 1000.0);
  EXPECT_GT(answer.latency_s, 0.0);
  EXPECT_LT(answer.latency_s, answer.age_s);
  ASSERT_TRUE(test_.WaitFor([&] { return mesh_state_ns_ == stamp_ns; }));
  EXPECT_EQ(mesh_state_numbers_, 3u * 325u);
}

TEST_F(ShapeNodeTest, TheEstimatorSeesCloudCablesAndContactsInTheRobotsFrame) {
  Ask({.stamp_ns = 1'500'000'000});
  const ShapeFrame frame = script_.calls().at(0).shape.frame;
  EXPECT_EQ(frame.t_s, 1.5);
  EXPECT_EQ(frame.views[0].cloud.points_m(1, 0), 0.25f);
  EXPECT_EQ(frame.views[0].T_robot_camera.translation().z(), 0.5);
  ASSERT_EQ(frame.cables.size(), 1u);
  EXPECT_EQ(frame.cables[0].value, kCable_m);
  ASSERT_EQ(frame.contacts.size(), 1u);
  const SeenContact& contact = frame.contacts[0];
  EXPECT_EQ(contact.name, "contact_1");
  // Turned by 180 degrees about x, then 0.5 m up.
  EXPECT_TRUE(contact.position_m.isApprox(Eigen::Vector3d(0.1, -0.2, 0.2), 1e-14));
  EXPECT_NEAR(contact.covariance_m2(0, 1), -2e-6, 1e-20);
  EXPECT_EQ(contact.extent_m, Eigen::Vector3d(0.01, 0.02, 0.03));
  EXPECT_EQ(contact.point_count, 5);
}

/// Perception predicts the first image from it.
TEST_F(ShapeNodeTest, TheCablesGiveAPostureBeforeTheFirstFrame) {
  SendCable(1'000);
  ASSERT_TRUE(test_.WaitFor([&] { return mesh_state_numbers_ == 3u * 325u; }));
  EXPECT_EQ(mesh_state_ns_, 999);  // no answer to a frame of the cables' stamp
  EXPECT_TRUE(script_.calls().empty());
  EXPECT_TRUE(answers_.empty());
  ASSERT_EQ(script_.expected().size(), 1u);
  const auto model = NodeTestRobot();
  fem::StaticState state = model->RestState();
  const robot::ActuatorCommand pulled{robot::ActuatorCommand::Kind::kDisplacement, kCable_m};
  ASSERT_TRUE(model->Solve({pulled}, {}, &state).status.ok());
  EXPECT_TRUE(script_.expected()[0].isApprox(state.x_m, 1e-6));
  // The first frame begins a pipeline, which knows of it.
  EXPECT_EQ(Ask({.stamp_ns = 2'000}).status, "ok");
  EXPECT_EQ(script_.expected().size(), 2u);
  ASSERT_TRUE(test_.WaitFor([&] { return mesh_state_ns_ == 2'000; }));
  // Frames tell where the robot is from then on.
  SendCable(3'000);
  EXPECT_EQ(Ask({.stamp_ns = 4'000}).status, "ok");
  EXPECT_THAT(mesh_state_stamps_ns_, ::testing::Not(::testing::Contains(2'999)));
}

TEST_F(ShapeNodeTest, AFrameThatLostAPartIsLeftOutAndTheNextOneAnswered) {
  SendCable(10);
  perception_.SendCloud({.stamp_ns = 10});
  perception_.SendContacts({.stamp_ns = 10});
  EXPECT_EQ(Ask({.stamp_ns = 20}).status, "ok");
  EXPECT_EQ(answers_.size(), 1u);
}

TEST_F(ShapeNodeTest, PassesOnWhatPerceptionSays) {
  Ask({.stamp_ns = 10, .points = 0, .status = "stale"});
  const Status status = script_.calls().at(0).shape.perception;
  EXPECT_EQ(status.code(), StatusCode::kStale);
  EXPECT_EQ(status.message(), "as perception says");
  Ask({.stamp_ns = 20});
  EXPECT_TRUE(script_.calls().at(1).shape.perception.ok());
}

TEST_F(ShapeNodeTest, WithoutCableInputsOfItsTimeAFrameIsStaleAndTheNextRecovers) {
  const Answer answer = AskWithoutCable({.stamp_ns = 10});
  EXPECT_EQ(answer.status, "stale");
  EXPECT_THAT(answer.reason, HasSubstr("no cable inputs"));
  // Whoever waits for the model's state is answered, too.
  ASSERT_TRUE(test_.WaitFor([&] { return mesh_state_ns_ == 10; }));
  EXPECT_EQ(mesh_state_numbers_, 0u);
  EXPECT_EQ(Ask({.stamp_ns = 20}).status, "ok");
}

TEST_F(ShapeNodeTest, OfTheFramesThatWaitTheNewestWins) {
  Ask({.stamp_ns = 10});
  script_.Hold(true);
  for (std::int64_t stamp_ns = 20; stamp_ns < 30; ++stamp_ns) {
    SendCable(stamp_ns);
    perception_.Send({.stamp_ns = stamp_ns});
    ASSERT_TRUE(test_.WaitFor([&] { return script_.calls().size() == 2; }));
  }
  ASSERT_TRUE(test_.WaitFor([&] { return received_ == 11; }));
  script_.Hold(false);
  ASSERT_TRUE(test_.WaitFor([&] { return answers_.back().stamp_ns == 29; }));
  ASSERT_EQ(script_.calls().size(), 3u);
  EXPECT_EQ(script_.calls()[1].shape.frame.t_s, 20e-9);
  EXPECT_EQ(script_.calls().back().shape.frame.t_s, 29e-9);
}

TEST_F(ShapeNodeTest, SaysStaleOnceASecondWhenTheCloudsStopAndGoesOnWhenTheyComeAgain) {
  Ask({.stamp_ns = 10});
  ASSERT_TRUE(test_.WaitFor([&] { return answers_.size() >= 3; }));
  for (std::size_t i = 1; i < 3; ++i) {
    EXPECT_EQ(answers_[i].status, "stale");
    EXPECT_THAT(answers_[i].reason, HasSubstr("no clouds for"));
    EXPECT_EQ(answers_[i].stamp_ns, 10);
    EXPECT_TRUE(answers_[i].force_z_N.empty());
  }
  EXPECT_GT(answers_[2].age_s, answers_[1].age_s);
  EXPECT_EQ(Ask({.stamp_ns = 20}).status, "ok");
}

TEST_F(ShapeNodeTest, ANewEpochKeepsWhatWasLearntAndAnotherCameraDoesNot) {
  Ask({.stamp_ns = 100, .epoch = 1});
  Ask({.stamp_ns = 200, .epoch = 2});                        // opened again
  Ask({.stamp_ns = 50, .epoch = 3});                         // the next recording
  Ask({.stamp_ns = 60, .device = "Palpate-2", .epoch = 3});  // another camera
  Ask({.stamp_ns = 50, .device = "Palpate-2", .epoch = 1});  // played again from the start
  const auto calls = script_.calls();
  ASSERT_EQ(calls.size(), 5u);
  EXPECT_EQ(calls[1].pipeline, calls[0].pipeline);
  EXPECT_EQ(calls[2].pipeline, calls[0].pipeline);
  EXPECT_NE(calls[3].pipeline, calls[0].pipeline);
  EXPECT_NE(calls[4].pipeline, calls[3].pipeline);
}

TEST_F(ShapeNodeTest, AnswersARepeatedFrameAgainWithoutWorkingOnIt) {
  const Answer first = Ask({.stamp_ns = 10, .points = 4});
  const Answer second = AskWithoutCable({.stamp_ns = 10, .points = 4});
  EXPECT_EQ(second.force_z_N, first.force_z_N);
  EXPECT_EQ(script_.calls().size(), 1u);
}

TEST_F(ShapeNodeTest, RefusesAContactThatIsNoNumberAndRecoversWithTheNextFrame) {
  const Answer answer =
      Ask({.stamp_ns = 10, .contact_x_m = std::numeric_limits<double>::quiet_NaN()});
  EXPECT_EQ(answer.status, "invalid_input");
  EXPECT_THAT(answer.reason, HasSubstr("/perception/contacts: contact 'contact_1'"));
  EXPECT_EQ(Ask({.stamp_ns = 20}).status, "ok");
}

NodeConfig WithoutPose() {
  NodeConfig config = TestConfig();
  config.source = "shape";
  config.camera_pose.clear();
  return config;
}

class WithoutPoseTest : public ShapeNodeTest {
 protected:
  WithoutPoseTest() : ShapeNodeTest(WithoutPose()) {}
};

TEST_F(WithoutPoseTest, TakesTheCameraPoseOfTheTransforms) {
  const Answer before = Ask({.stamp_ns = 10});
  EXPECT_EQ(before.status, "no_calibration");
  EXPECT_THAT(before.reason, HasSubstr("/tf"));
  EXPECT_TRUE(script_.calls().empty());
  Eigen::Isometry3d T_robot_mount = Eigen::Isometry3d::Identity();
  T_robot_mount.translation().x() = 0.2;
  Eigen::Isometry3d T_mount_camera = Eigen::Isometry3d::Identity();
  T_mount_camera.translation().z() = 0.5;
  dds::TransformBroadcaster transforms(test_.participant);
  ASSERT_TRUE(transforms.Set(geometry::kRobotFrame, "mount", T_robot_mount, 1));
  ASSERT_TRUE(transforms.Set("mount", geometry::kCameraDepthOpticalFrame, T_mount_camera, 1));
  std::int64_t stamp_ns = 10;
  Answer answer;
  const auto deadline = dds::WaitSet::Clock::now() + std::chrono::seconds(20);
  while (answer.status != "ok" && dds::WaitSet::Clock::now() < deadline) {
    answer = Ask({.stamp_ns = stamp_ns += 10});
  }
  ASSERT_EQ(answer.status, "ok") << answer.reason;
  EXPECT_EQ(script_.calls().at(0).shape.frame.views[0].T_robot_camera.translation(),
            Eigen::Vector3d(0.2, 0.0, 0.5));
}

TEST(PipelineMaker, LearnsNoDepthBiasThatTheCalibrationGives) {
  const auto model = NodeTestRobot();
  const auto to_come = [&](const robot::CalibrationFile& calibration) {
    PerceivedShape shape;
    shape.frame.cables = {robot::ActuatorCommand()};
    return PipelineMakerOf(TestConfig(), calibration)(*model)->Update(shape).bias_frames_to_come;
  };
  robot::CalibrationFile calibration;
  EXPECT_EQ(to_come(calibration), ShapeConfig().untouched_frames);
  calibration.pose.emplace();
  auto& map = calibration.depth_bias.emplace().map;
  const int count = geometry::CountOf(map.basis);
  map.coefficients = Eigen::VectorXd::Zero(count);
  map.covariance = 1e-6 * Eigen::MatrixXd::Identity(6 + count, 6 + count);
  EXPECT_EQ(to_come(calibration), 0);
}

TEST(ShapeNode, NeedsACameraPoseWhereNoCalibrationMaySayIt) {
  NodeConfig config;
  config.source = "shape";
  config.follow_calibration = false;
  Script script;
  EXPECT_THROW(ForceEstimationNode(config, NodeTestRobot(), {}, static_cast<int>(dds::TestDomain()),
                                   dds::BuiltInTable(), {}, script.Maker()),
               InputError);
  EXPECT_FALSE(IsFromShape(NodeConfig()));
  EXPECT_TRUE(IsFromShape(TestConfig()));
  config = TestConfig();
  config.source = "markers";
  EXPECT_FALSE(IsFromShape(config));
}

TEST_F(ShapeNodeTest, SaysWhereTheCalibrationNoLongerHoldsAndHowFarTheCameraMoved) {
  std::int64_t stamp_ns = 0;
  // Frames go on, for the node says it first where they do not.
  const auto said_of_frames = [&](const std::string& drift) {
    const auto deadline = dds::WaitSet::Clock::now() + std::chrono::seconds(20);
    while (values_["drift"] != drift || values_["status"] == "stale") {
      if (dds::WaitSet::Clock::now() > deadline) return false;
      Ask({.stamp_ns = stamp_ns += 10});
    }
    return true;
  };
  ASSERT_TRUE(said_of_frames("learning"));
  DriftReport moved;
  moved.state = DriftReport::State::kMoved;
  moved.motion << 0.001, 0.002, 0.003, 0.004, 0.005, 0.006;
  moved.standard_error << 0.01, 0.02, 0.03, 0.04, 0.05, 0.06;
  moved.advice = "calibrate again";
  script_.SetDrift(moved);
  ASSERT_TRUE(said_of_frames("moved"));
  EXPECT_EQ(values_["status"], "no_calibration");
  EXPECT_THAT(said_, HasSubstr("calibrate again"));
  EXPECT_EQ(values_["drift_turn_rad"], "0.001 0.002 0.003");
  EXPECT_EQ(values_["drift_turn_error_rad"], "0.01 0.02 0.03");
  EXPECT_EQ(values_["drift_shift_m"], "0.004 0.005 0.006");
  EXPECT_EQ(values_["drift_shift_error_m"], "0.04 0.05 0.06");
  moved.state = DriftReport::State::kHolds;
  script_.SetDrift(moved);
  ASSERT_TRUE(said_of_frames("holds"));
  EXPECT_EQ(values_["status"], "ok");
}

}  // namespace
}  // namespace palpate::force_estimation
