// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/pose/unlabelled_calibration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>

#include "components/calibration/pose/tension_range.hpp"
#include "tests/components/calibration/table_one.hpp"

/// The four legs, which look the same after quarter turns but for what their cables do.
namespace palpate::calibration {
namespace {

using Kind = robot::ActuatorCommand::Kind;
using testing::HasSubstr;

class FourLegsWithoutNames : public testing::Test {
 protected:
  /// All nine, in random order, of a robot whose cables take in what is commanded.
  UnlabelledFrame Take(const std::string& name, const Eigen::Vector4d& displacement_m) {
    UnlabelledFrame frame{.frame = {.name = name, .gravity_m_s2 = model_->gravity_m_s2()},
                          .points = {}};
    for (const double u_m : displacement_m)
      frame.frame.cables.push_back({Kind::kDisplacement, u_m});
    fem::StaticState state = model_->RestState();
    EXPECT_TRUE(model_->Solve(frame.frame.cables, {}, &state).status.ok());
    frame.points = Sight(*model_, state, TableOnePose(), kNineMarkers, 3e-4);
    std::shuffle(frame.points.begin(), frame.points.end(), random_);
    std::normal_distribution<double> noise(0.0, 3e-4);
    truth_.emplace_back();
    for (MarkerSighting& point : frame.points) {
      truth_.back().push_back(point.marker);
      for (int i = 0; i < 3; ++i) point.position_m[i] += noise(random_);
      point.marker = -1;
    }
    return frame;
  }

  UnlabelledCalibration Calibrate(const std::vector<UnlabelledFrame>& frames,
                                  const geometry::RigidTransform* T_rough = nullptr) {
    return CalibrateUnlabelled(*model_, frames, T_rough, settings_);
  }

  /// Off by so much about the robot's middle axis.
  static geometry::RigidTransform TurnedPose(double angle_rad) {
    const Eigen::Matrix3d R =
        Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    return geometry::RigidTransform(R, Eigen::Vector3d::Zero()) * TableOnePose();
  }

  static void ExpectPose(const UnlabelledCalibration& found, const geometry::RigidTransform& pose) {
    const Eigen::Vector3d middle_m(0.0, 0.0, 0.08);
    EXPECT_LT((found.joint.T_robot_camera * (pose.Inverse() * middle_m) - middle_m).norm(), 1e-3);
    EXPECT_LT(found.joint.T_robot_camera.rotation().angularDistance(pose.rotation()), 0.02);
  }

  std::unique_ptr<robot::RobotModel> model_ = Build(QuickFourLegRobot());
  std::mt19937 random_{20261122};
  std::vector<std::vector<int>> truth_;
  UnlabelledSettings settings_;
};

TEST_F(FourLegsWithoutNames, WhatTheCablesWereSetToTellsTheQuarterTurn) {
  settings_.request.actuator_offset_sigma_m = 5e-4;
  const UnlabelledCalibration found =
      Calibrate({Take("a", {0.009, 0.002, 0.002, 0.002}), Take("b", {0.002, 0.009, 0.002, 0.004}),
                 Take("c", {0.003, 0.003, 0.008, 0.008})});
  ASSERT_TRUE(found.status.ok()) << found.status.message();
  EXPECT_GE(found.choices, 2);
  EXPECT_EQ(found.labels.marker_of_point, truth_);
  EXPECT_TRUE(found.left_out.empty());
  ExpectPose(found, TableOnePose());
}

TEST_F(FourLegsWithoutNames, CablesThatAreAllSetAlikeLeaveItAmbiguousUnlessThePoseIsRoughlyKnown) {
  const std::vector<UnlabelledFrame> frames = {Take("a", {0.004, 0.004, 0.004, 0.004}),
                                               Take("b", {0.008, 0.008, 0.008, 0.008})};
  const UnlabelledCalibration found = Calibrate(frames);
  EXPECT_EQ(found.status.code(), StatusCode::kUnobservable);
  EXPECT_THAT(found.status.message(), HasSubstr("ambiguous"));
  EXPECT_EQ(found.choices, 4);
  for (const double off_rad : {-0.35, 0.35}) {
    const geometry::RigidTransform rough = TurnedPose(off_rad);
    const UnlabelledCalibration told = Calibrate(frames, &rough);
    ASSERT_TRUE(told.status.ok()) << told.status.message();
    EXPECT_EQ(told.labels.marker_of_point, truth_);
    ExpectPose(told, TableOnePose());
  }
}

TEST_F(FourLegsWithoutNames, TheLastPoseTellsWhatIsLeftAmbiguousIfTheCameraStandsThereStill) {
  const std::vector<UnlabelledFrame> frames = {Take("a", {0.004, 0.004, 0.004, 0.004}),
                                               Take("b", {0.008, 0.008, 0.008, 0.008})};
  settings_.T_robot_camera_last = TurnedPose(0.1);
  const UnlabelledCalibration told = Calibrate(frames);
  ASSERT_TRUE(told.status.ok()) << told.status.message();
  EXPECT_TRUE(told.decided_by_last_pose);
  EXPECT_EQ(told.labels.marker_of_point, truth_);
  ExpectPose(told, TableOnePose());
  settings_.T_robot_camera_last = TurnedPose(std::numbers::pi / 4.0);  // between two of them
  EXPECT_EQ(Calibrate(frames).status.code(), StatusCode::kUnobservable);
}

TEST_F(FourLegsWithoutNames, WhatTheCablesTellGoesBeforeTheLastPose) {
  settings_.request.actuator_offset_sigma_m = 5e-4;
  settings_.T_robot_camera_last = TurnedPose(std::numbers::pi / 2.0);
  const UnlabelledCalibration found =
      Calibrate({Take("a", {0.009, 0.002, 0.002, 0.002}), Take("b", {0.002, 0.009, 0.002, 0.004}),
                 Take("c", {0.003, 0.003, 0.008, 0.008})});
  ASSERT_TRUE(found.status.ok()) << found.status.message();
  EXPECT_FALSE(found.decided_by_last_pose);
  EXPECT_EQ(found.labels.marker_of_point, truth_);
}

TEST_F(FourLegsWithoutNames, APictureOfAnotherPoseIsLeftOutAndSoIsOneOfNothing) {
  std::vector<UnlabelledFrame> frames = {
      Take("a", {0.009, 0.002, 0.002, 0.002}), Take("knocked", {0.002, 0.009, 0.002, 0.004}),
      Take("c", {0.003, 0.003, 0.008, 0.008}), Take("empty", {0.003, 0.003, 0.008, 0.008})};
  for (MarkerSighting& point : frames[1].points) point.position_m.x() += 0.1;
  frames[3].points.clear();
  const auto rough = TableOnePose();
  const UnlabelledCalibration found = Calibrate(frames, &rough);
  ASSERT_TRUE(found.status.ok()) << found.status.message();
  EXPECT_EQ(found.labels.frames, (std::vector<std::size_t>{0, 2}));
  ASSERT_EQ(found.left_out.size(), 2u);
  EXPECT_THAT(found.left_out, testing::Contains(HasSubstr("knocked: its points need another")));
  EXPECT_THAT(found.left_out, testing::Contains(HasSubstr("empty: an assignment needs 5")));
}

TEST_F(FourLegsWithoutNames, NamesThatAreThereHold) {
  std::vector<UnlabelledFrame> frames = {Take("a", {0.009, 0.002, 0.002, 0.002}),
                                         Take("b", {0.002, 0.009, 0.002, 0.004})};
  for (std::size_t f = 0; f < 2; ++f) {
    for (std::size_t p = 0; p < 9; ++p) frames[f].points[p].marker = truth_[f][p];
  }
  frames[0].points[4].marker = -1;
  settings_.named = true;
  const UnlabelledCalibration found = Calibrate(frames);
  ASSERT_TRUE(found.status.ok()) << found.status.message();
  EXPECT_EQ(found.frames[0].markers.size(), 8u);
  EXPECT_EQ(found.choices, 1);
  ExpectPose(found, TableOnePose());
}

/// A slope of the depth looks like a turn of the camera: the errors must say so.
TEST_F(FourLegsWithoutNames, WhatAllDepthsHaveInCommonWidensTheErrors) {
  const std::vector<UnlabelledFrame> frames = {Take("a", {0.009, 0.002, 0.002, 0.002}),
                                               Take("b", {0.002, 0.009, 0.002, 0.004})};
  const auto rough = TableOnePose();
  const auto error = [&](double sigma) {
    settings_.request.depth_bias_sigma = sigma;
    return Calibrate(frames, &rough).joint.pose_covariance.diagonal().cwiseSqrt().eval();
  };
  EXPECT_GT(error(0.003).head<3>().norm(), 2.0 * error(0.0).head<3>().norm());
}

TEST_F(FourLegsWithoutNames, TheRangeOfTensionsHoldsWhatTheInputsAskFor) {
  const UnlabelledFrame frame = Take("a", {0.009, 0.002, 0.002, 0.002});
  fem::StaticState state = model_->RestState();
  ASSERT_TRUE(model_->Solve(frame.frame.cables, {}, &state).status.ok());
  Eigen::VectorXd most_N;
  ASSERT_TRUE(FindTensionRange(*model_, {frame.frame}, 2e-3, &most_N).ok());
  for (int c = 0; c < 4; ++c) {
    EXPECT_GT(most_N[c], model_->StateOfActuator(c, state).tension_N);
    EXPECT_LT(most_N[c], 20.0);
  }
  EXPECT_GT(most_N[0], 1.5 * most_N[2]);
  // Of cables of which nothing is known: up to what moves the markers far.
  CalibrationFrame unknown = frame.frame;
  unknown.cables.assign(4, {});
  ASSERT_TRUE(FindTensionRange(*model_, {unknown}, 2e-3, &most_N).ok());
  for (int c = 0; c < 4; ++c) {
    EXPECT_GT(most_N[c], 0.1);
    EXPECT_LE(most_N[c], 20.0);
  }
}

}  // namespace
}  // namespace palpate::calibration
