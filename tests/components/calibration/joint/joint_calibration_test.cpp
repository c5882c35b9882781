// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/joint_calibration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <random>

#include "components/calibration/joint/joint_request.hpp"
#include "tests/components/calibration/joint/joint_scene.hpp"

namespace palpate::calibration {
namespace {

using testing::HasSubstr;

const std::vector<double> kPaperTensions_N(kTableOneForces_N.begin(), kTableOneForces_N.end());

void FreeTensions(const robot::RobotModel& model, double start_N, JointSetup* setup) {
  for (int c = 0; c < model.ActuatorCount(); ++c) {
    setup->frames[0].cables[static_cast<size_t>(c)] = {Kind::kTension, start_N};
    setup->unknowns.push_back(CableInput(0, "table_1", c,
                                         model.ActuatorNames()[static_cast<size_t>(c)],
                                         Kind::kTension, {.mean = start_N, .lower = 0.0}));
  }
}

/// Table I of the paper: pose and four tensions from so many markers.
void FindTableOne(robot::RobotModel& model) {
  JointSetup setup;
  setup.frames = {
      See(model, TableOnePose(), "table_1", Commands(Kind::kTension, kPaperTensions_N), {}, 1e-4)};
  FreeTensions(model, 0.5, &setup);
  setup.T_robot_camera = Disturbed(TableOnePose(), 0.2, 0.03);
  const JointCalibration fit = CalibrateJointly(model, setup);
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  EXPECT_LE(fit.residual_rms_m, 1e-9);
  ExpectPose(fit.T_robot_camera, TableOnePose(), 1e-6, 1e-6);
  for (std::size_t c = 0; c < kPaperTensions_N.size(); ++c) {
    EXPECT_NEAR(fit.values[c].value, kPaperTensions_N[c], 1e-6) << fit.values[c].name;
    EXPECT_TRUE(fit.values[c].determined);
  }
  EXPECT_LE(fit.iterations, 10);
}

/// The markers of Table I (i) and (ii).
robot::RobotDescription WithMarkers(robot::RobotDescription robot, const std::vector<int>& chosen) {
  const auto all = robot.markers;
  robot.markers.clear();
  for (const int marker : chosen) robot.markers.push_back(all.at(static_cast<size_t>(marker)));
  return robot;
}

TEST(JointTableOne, IsFoundOnTheDiamond) {
  const auto robot = DiamondWithMarkers();
  if (!robot) GTEST_SKIP() << "no diamond.vtu in " << test_support::MeasuredDataFolder();
  FindTableOne(*Build(WithMarkers(*robot, kFiveMarkers)));
  FindTableOne(*Build(WithMarkers(*robot, kNineMarkers)));
}

TEST(JointTableOne, IsFoundOnOurRobot) {
  FindTableOne(*Build(WithMarkers(QuickFourLegRobot(), kFiveMarkers)));
  FindTableOne(*Build(WithMarkers(QuickFourLegRobot(), kNineMarkers)));
}

class JointCalibrationOfOurRobot : public testing::Test {
 protected:
  JointCalibrationOfOurRobot() : model_(Build(OfOneMaterial())) {}

  static robot::RobotDescription OfOneMaterial() {
    robot::RobotDescription robot = QuickFourLegRobot();
    robot.regions.clear();
    return robot;
  }

  /// Frames at several settings, all of them with unknown displacements about what was measured.
  JointSetup Frames(int count, double sigma_m, std::mt19937_64* random) {
    JointSetup setup;
    for (int f = 0; f < count; ++f) {
      std::vector<double> pulled_m;
      for (int c = 0; c < 4; ++c) pulled_m.push_back(1e-3 * (3.0 + (3 * f + 2 * c) % 5));
      const std::string name = "frame" + std::to_string(f);
      setup.frames.push_back(See(*model_, TableOnePose(), name,
                                 Commands(Kind::kDisplacement, pulled_m), {}, sigma_m, random));
    }
    setup.T_robot_camera = Disturbed(TableOnePose(), 0.1, 0.02);
    return setup;
  }

  std::unique_ptr<robot::RobotModel> model_;
};

TEST_F(JointCalibrationOfOurRobot, OffsetsAndGainsOfCablesShow) {
  JointSetup setup = Frames(4, 1e-4, nullptr);
  std::vector<double> measured_m;
  for (CalibrationFrame& frame : setup.frames) {
    robot::ActuatorCommand& north = frame.cables[0];
    north.value = (north.value - 7e-4) / 1.05;
    measured_m.push_back(north.value);
  }
  setup.unknowns.push_back(CommandOffset(0, "north", {.plausible = 2e-3}));
  setup.unknowns.push_back(CommandGain(0, "north", measured_m, {.plausible = 0.2}));
  const JointCalibration fit = CalibrateJointly(*model_, setup);
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  EXPECT_NEAR(ValueNamed(fit, "cable_offset:north")->value, 7e-4, 1e-8);
  EXPECT_NEAR(ValueNamed(fit, "cable_gain:north")->value, 0.05, 1e-5);
  ExpectPose(fit.T_robot_camera, TableOnePose(), 1e-7, 1e-8);
}

TEST_F(JointCalibrationOfOurRobot, WhatTheDataDoNotTellIsHeldAndNamed) {
  const Eigen::Vector3d gravity_m_s2 = model_->gravity_m_s2();
  model_->SetGravity(Eigen::Vector3d::Zero());
  JointSetup setup = Frames(2, 1e-4, nullptr);
  setup.unknowns.push_back(LogYoungsModulus(0, "body", 1e5, {.sigma = 0.3}));
  const JointCalibration fit = CalibrateJointly(*model_, setup);
  model_->SetGravity(gravity_m_s2);
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  const FittedValue& modulus = *ValueNamed(fit, "youngs_modulus:body");
  EXPECT_FALSE(modulus.determined);
  EXPECT_NEAR(modulus.value, 1e5, 1e-4);
  EXPECT_NEAR(modulus.standard_error, 0.3 * 1e5, 1.0);
  EXPECT_THAT(modulus.what_would_tell, HasSubstr("known load"));
  ExpectPose(fit.T_robot_camera, TableOnePose(), 1e-7, 1e-8);
}

TEST_F(JointCalibrationOfOurRobot, MarkersOnOneLineAreRefused) {
  JointSetup setup = Frames(1, 1e-4, nullptr);
  setup.frames[0].markers.resize(2);
  const JointCalibration fit = CalibrateJointly(*model_, setup);
  EXPECT_EQ(fit.status.code(), StatusCode::kUnobservable);
  EXPECT_THAT(fit.status.message(), HasSubstr("camera pose"));
  EXPECT_THAT(fit.status.message(), HasSubstr("are not collinear"));
}

/// Two markers determine no pose, but agree with one that is known.
TEST_F(JointCalibrationOfOurRobot, APoseWithAPriorIsNeverHeld) {
  JointSetup setup = Frames(2, 1e-4, nullptr);
  for (CalibrationFrame& frame : setup.frames) frame.markers.resize(2);
  setup.pose_prior = PosePrior{.name = "camera",
                               .T_robot_camera = TableOnePose(),
                               .translation_sigma_m = 1e-3,
                               .rotation_sigma_rad = 2e-3};
  const JointCalibration fit = CalibrateJointly(*model_, setup);
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  ExpectPose(fit.T_robot_camera, TableOnePose(), 1e-5, 1e-5);
  EXPECT_LE(fit.pose_covariance(5, 5), 1e-6);
  ASSERT_EQ(fit.adjusted_poses.size(), 1U);
  EXPECT_LE(fit.adjusted_poses[0].chi_squared, 1e-3);
}

/// The error of a pose counts in what is found from there.
TEST_F(JointCalibrationOfOurRobot, AnErrorOfAnotherPoseCountsInTheOffsets) {
  const auto fit_with = [&](double translation_sigma_m) {
    JointSetup setup = Frames(3, 1e-4, nullptr);
    setup.fit_pose = false;
    setup.own_poses = {PosePrior{.name = "other",
                                 .T_robot_camera = Disturbed(TableOnePose(), 0.0, 1e-3),
                                 .translation_sigma_m = translation_sigma_m,
                                 .rotation_sigma_rad = 1e-3}};
    for (CalibrationFrame& frame : setup.frames) frame.own_pose = 0;
    setup.unknowns.push_back(CommandOffset(0, "north", {.sigma = 2e-3, .plausible = 2e-3}));
    return CalibrateJointly(*model_, setup);
  };
  const JointCalibration honest = fit_with(5e-3);
  ASSERT_TRUE(honest.status.ok()) << honest.status.message();
  const FittedValue* offset = ValueNamed(honest, "cable_offset:north");
  EXPECT_NEAR(offset->value, 0.0, 3.0 * offset->standard_error);
  ExpectPose(honest.adjusted_poses[0].T_robot_camera, TableOnePose(), 1e-3, 1e-3);
  const JointCalibration exact = fit_with(1e-6);
  ASSERT_TRUE(exact.status.ok()) << exact.status.message();
  EXPECT_GT(std::abs(ValueNamed(exact, "cable_offset:north")->value),
            std::abs(offset->value) + 1e-5);
  EXPECT_GT(exact.adjusted_poses[0].chi_squared, 0.0);
}

TEST_F(JointCalibrationOfOurRobot, AnOutlierCountsLittleWithARobustLoss) {
  std::mt19937_64 random(3);
  JointSetup setup = Frames(2, 1e-4, &random);
  setup.frames[0].markers[2].position_m += Eigen::Vector3d(0.02, 0.0, 0.01);
  JointSettings settings;
  const JointCalibration plain = CalibrateJointly(*model_, setup, settings);
  settings.solver.huber_threshold = 3.0;
  const JointCalibration robust = CalibrateJointly(*model_, setup, settings);
  ASSERT_TRUE(plain.status.ok() && robust.status.ok());
  const auto off_m = [](const JointCalibration& fit) {
    return (fit.T_robot_camera * Eigen::Vector3d(0.0, 0.0, 0.4) -
            TableOnePose() * Eigen::Vector3d(0.0, 0.0, 0.4))
        .norm();
  };
  EXPECT_LE(off_m(robust), 3e-4);
  EXPECT_GE(off_m(plain), 1e-3);
}

/// Errors of pose and offset over their standard errors, from 40 seeds: of 280 numbers 95 % within
/// 1.96, and not all.
TEST_F(JointCalibrationOfOurRobot, StandardErrorsHoldTheirLevel) {
  int within = 0;
  int all = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    std::mt19937_64 random(seed);
    JointSetup setup = Frames(1, 3e-4, &random);
    setup.frames[0].cables[0].value -= 7e-4;
    setup.unknowns.push_back(CommandOffset(0, "north", {.plausible = 5e-3}));
    setup.T_robot_camera = TableOnePose();
    const JointCalibration fit = CalibrateJointly(*model_, setup);
    ASSERT_TRUE(fit.status.ok()) << "seed " << seed << ": " << fit.status.message();
    PoseChange error;
    const Eigen::AngleAxisd turn(TableOnePose().rotation() *
                                 fit.T_robot_camera.rotation().inverse());
    error.head<3>() = turn.angle() * turn.axis();
    error.tail<3>() = TableOnePose().translation_m() - fit.T_robot_camera.translation_m();
    for (int i = 0; i < 6; ++i) {
      within += std::abs(error[i]) <= 1.96 * std::sqrt(fit.pose_covariance(i, i));
    }
    within += std::abs(fit.values[0].value - 7e-4) <= 1.96 * fit.values[0].standard_error;
    all += 7;
  }
  std::printf("%d of %d within their 95 %% intervals\n", within, all);
  EXPECT_GE(within, all * 88 / 100);
  EXPECT_LE(within, all * 99 / 100);
}

TEST_F(JointCalibrationOfOurRobot, AWindingDrumTiesTwoCables) {
  JointSetup setup;
  setup.frames = {See(*model_, TableOnePose(), "table_1",
                      Commands(Kind::kTension, {1.2, 0.4, 0.3, 0.5}), {}, 1e-3)};
  const fem::StaticState truth =
      force_estimation::SolveTruth(*model_, Commands(Kind::kTension, {1.2, 0.4, 0.3, 0.5}), {});
  const double sum_m =
      model_->cable(0).Displacement_m(truth.x_m) + model_->cable(2).Displacement_m(truth.x_m);
  FreeTensions(*model_, 0.5, &setup);
  setup.frames[0].markers[4].position_m.x() += 2e-3;  // would pull them elsewhere
  setup.conditions.push_back(CableLengths(0, {1.0, 0.0, 1.0, 0.0}, sum_m, sum_m));
  setup.T_robot_camera = TableOnePose();
  JointProblem problem(*model_, setup);
  const LeastSquaresSolution tied = SolveLeastSquares(problem, {});
  ASSERT_TRUE(tied.status.ok()) << tied.status.message();
  EXPECT_NEAR(tied.point.constraint[0], 1e3 * sum_m, 1e-6);
  setup.conditions.clear();
  JointProblem untied(*model_, setup);
  const LeastSquaresSolution loose = SolveLeastSquares(untied, {});
  ASSERT_TRUE(loose.status.ok());
  const fem::StaticState& state = untied.states()[0];
  EXPECT_GT(std::abs(model_->cable(0).Displacement_m(state.x_m) +
                     model_->cable(2).Displacement_m(state.x_m) - sum_m),
            1e-5);
}

TEST_F(JointCalibrationOfOurRobot, APlaneIsNotEnteredWhateverTheMarkersSay) {
  const auto tensions = Commands(Kind::kTension, {1.2, 0.4, 0.3, 0.5});
  JointSetup setup;
  setup.frames = {See(*model_, TableOnePose(), "table_1", tensions, {}, 1e-3)};
  FreeTensions(*model_, 0.5, &setup);
  setup.frames[0].markers[4].position_m.x() += 2e-3;
  setup.T_robot_camera = TableOnePose();
  setup.fit_pose = false;
  const fem::InterpolationWeights tip = model_->body().markers[4].point.weights;
  const fem::StaticState truth = force_estimation::SolveTruth(*model_, tensions, {});
  JointProblem anywhere(*model_, setup);
  const LeastSquaresSolution loose = SolveLeastSquares(anywhere, {});
  ASSERT_TRUE(loose.status.ok()) << loose.status.message();
  const Eigen::Vector3d at_m = tip.Position(truth.x_m);
  const Eigen::Vector3d off_m = at_m - tip.Position(anywhere.states()[0].x_m);
  ASSERT_GT(off_m.norm(), 1e-4);
  setup.conditions.push_back(StaysBeyondPlane(0, tip, at_m, off_m.normalized()));
  JointProblem before(*model_, setup);
  const LeastSquaresSolution kept = SolveLeastSquares(before, {});
  ASSERT_TRUE(kept.status.ok()) << kept.status.message();
  EXPECT_NEAR(kept.point.constraint[0], 0.0, 1e-5);  // mm: it lies against the plane
  EXPECT_GE(kept.point.constraint[0], -1e-6);
  EXPECT_GT(kept.objectives.back(), loose.objectives.back());
}

TEST_F(JointCalibrationOfOurRobot, AnotherRobotIsRefusedAndTheModelStaysAsItWas) {
  JointSetup setup = Frames(2, 1e-4, nullptr);
  for (CalibrationFrame& frame : setup.frames) {
    for (std::size_t m = 0; m < 4; ++m) frame.markers[m].position_m *= 1.2;
  }
  const double before_Pa = model_->body().materials[0].youngs_modulus_Pa;
  const geometry::RigidTransform start = TableOnePose();
  const JointCalibration fit =
      CalibrateFrames(*model_, setup.frames, &start, {.moduli = {0}, .huber_threshold = 0.0});
  EXPECT_FALSE(fit.status.ok());
  EXPECT_EQ(model_->body().materials[0].youngs_modulus_Pa, before_Pa);
}

}  // namespace
}  // namespace palpate::calibration
