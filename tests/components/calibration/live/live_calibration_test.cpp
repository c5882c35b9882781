// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/live/live_calibration.hpp"

#include <gtest/gtest.h>

#include "components/calibration/live/earlier_calibration.hpp"
#include "tests/components/force_estimation/node/test_robot.hpp"
#include "tests/components/force_estimation/test_bodies.hpp"

namespace palpate::calibration {
namespace {

using Kind = robot::ActuatorCommand::Kind;

const Eigen::Vector3d kGravity_m_s2(1.5, -0.5, -9.0);
const robot::DriveCalibration kEarlierActuator{.offset_m = 4e-4, .gain = 0.05};
const robot::DriveCalibration kTrueActuator{.offset_m = 9e-4, .gain = 0.05};

Eigen::Isometry3d TruePose() {
  return Eigen::Translation3d(0.3, -0.2, 0.4) *
         Eigen::AngleAxisd(2.0, Eigen::Vector3d(0.3, -0.8, 0.5).normalized());
}

/// Of another material, gravity and actuator than the robot file's.
robot::CalibrationFile Earlier(const robot::RobotModel& robot) {
  robot::CalibrationFile before = robot::DescribeForCalibration(robot);
  before.date_utc = before.data = before.data_hash = "some";
  before.moduli = {{"body", 123e3, 4e3}};
  before.poissons_ratios = {{"body", 0.35, 0.01}};
  before.gravity = robot::CalibratedGravity{kGravity_m_s2, {0.1, 0.2, 0.3}};
  before.drives = {{"top", kEarlierActuator, {1e-4, 0.02}}};
  return before;
}

/// What the camera sees of a robot as `before` has it but for the zero of its actuator, as its
/// actuator tells it.
CalibrationFrame Frame(
    const robot::CalibrationFile& before, double told_m,
    const std::unique_ptr<robot::RobotModel>& robot = force_estimation::NodeTestRobot()) {
  robot::ApplyCalibration(before, robot.get());
  fem::StaticState state = robot->RestState();
  const auto result =
      robot->Solve({{Kind::kDisplacement, kTrueActuator.TakenIn_m(told_m)}}, {}, &state);
  EXPECT_TRUE(result.status.ok()) << result.status.message();
  CalibrationFrame frame{.name = "frame", .cables = {{Kind::kDisplacement, told_m}}};
  frame.gravity_m_s2 = robot->body().gravity_m_s2;  // nominal, as the collector has it
  const auto& markers = robot->body().markers;
  for (std::size_t k = 0; k < markers.size(); ++k) {
    frame.markers.push_back(
        {.marker = static_cast<int>(k),
         .position_m = TruePose().inverse() * markers[k].point.weights.Position(state.x_m),
         .covariance_m2 = 1e-10 * Eigen::Matrix3d::Identity()});
  }
  return frame;
}

TEST(LiveCalibration, KeepsWhatItDoesNotFindAnewAndFitsWithIt) {
  const auto robot = force_estimation::NodeTestRobot();
  const Eigen::Vector3d nominal_m_s2 = robot->gravity_m_s2();
  LiveJob job;
  job.before = Earlier(*robot);
  for (const double told_m : {0.0, 2e-3, 4e-3}) job.markers.push_back(Frame(*job.before, told_m));
  const LiveResult result = CalibrateLive(*robot, job);
  ASSERT_TRUE(result.status.ok()) << result.status.message();
  const robot::CalibrationFile& file = result.file;
  EXPECT_LT(file.residual_rms_m, 1e-7);
  ASSERT_TRUE(file.pose);
  EXPECT_TRUE(file.pose->T_robot_camera.isApprox(TruePose(), 1e-5));
  ASSERT_EQ(file.moduli.size(), 1u);
  EXPECT_EQ(file.moduli[0].youngs_modulus_Pa, 123e3);
  EXPECT_EQ(file.moduli[0].standard_error_Pa, 4e3);
  ASSERT_EQ(file.poissons_ratios.size(), 1u);
  EXPECT_EQ(file.poissons_ratios[0].poissons_ratio, 0.35);
  EXPECT_EQ(file.poissons_ratios[0].standard_error, 0.01);
  ASSERT_TRUE(file.gravity);
  EXPECT_EQ(file.gravity->gravity_m_s2, kGravity_m_s2);
  EXPECT_EQ(file.gravity->standard_error_m_s2, Eigen::Vector3d(0.1, 0.2, 0.3));
  ASSERT_EQ(file.drives.size(), 1u);
  EXPECT_NEAR(file.drives[0].drive.offset_m, kTrueActuator.offset_m, 1e-6);
  EXPECT_NEAR(file.drives[0].drive.gain, kTrueActuator.gain, 1e-12);
  EXPECT_EQ(file.drives[0].standard_error.gain, 0.02);
  EXPECT_NE(file.drives[0].standard_error.offset_m, 1e-4);
  // The model is as the robot file has it.
  EXPECT_EQ(robot->gravity_m_s2(), nominal_m_s2);
  EXPECT_EQ(robot->drives().at(0).offset_m, 0.0);
  EXPECT_EQ(robot->body().materials[0].poissons_ratio,
            force_estimation::NodeTestRobot()->body().materials[0].poissons_ratio);
}

/// A robot of another size than its file's, whose guide and eyelet sit elsewhere: with the earlier
/// file that says so its markers leave no residual.
TEST(LiveCalibration, TakesTheSizeAndTheRoutesOfTheEarlierOne) {
  robot::CalibrationFile before = Earlier(*force_estimation::NodeTestRobot());
  before.geometry_scale = robot::CalibratedScale{1.05, 1e-3};
  before.cable_routes = {{"top", 0, {0.0, 2e-3, 3e-3}, {0.0, 1e-4, 1e-4}},
                         {"top", 1, {0.0, 1e-3, 0.5e-3}, {0.0, 1e-4, 1e-4}}};
  robot::RobotBody body = robot::BuildRobotBody(force_estimation::NodeTestDescription());
  robot::ApplyGeometry(before, &body);
  robot::RobotModel large(body);
  LiveJob job;
  job.before = before;
  for (const double told_m : {0.0, 2e-3, 4e-3}) {
    job.markers.push_back(Frame(before, told_m, std::make_unique<robot::RobotModel>(body)));
  }
  const LiveResult result = CalibrateLive(large, job);
  ASSERT_TRUE(result.status.ok()) << result.status.message();
  EXPECT_LT(result.file.residual_rms_m, 1e-7);
  EXPECT_EQ(result.file.geometry_scale->scale, 1.05);
  EXPECT_EQ(result.file.cable_routes.at(0).moved_m, before.cable_routes[0].moved_m);
  EXPECT_TRUE(robot::CheckCalibration(result.file, large).ok());
  EXPECT_EQ(large.cable(0).pull_point_m(), body.cables[0].pull_point_m) << "left as it was";
  const auto small = force_estimation::NodeTestRobot();
  EXPECT_EQ(CalibrateLive(*small, job).status.code(), StatusCode::kInvalidInput);
}

TEST(LiveCalibration, EndsWhenItIsToldToAndLeavesTheModelAsItWas) {
  const auto robot = force_estimation::NodeTestRobot();
  const double modulus_Pa = robot->body().materials[0].youngs_modulus_Pa;
  std::stop_source stop;
  LiveJob job;
  job.before = Earlier(*robot);
  job.request.moduli = {0};
  job.request.stop = stop.get_token();
  for (const double told_m : {0.0, 2e-3, 4e-3}) job.markers.push_back(Frame(*job.before, told_m));
  stop.request_stop();
  EXPECT_EQ(CalibrateLive(*robot, job).status.code(), StatusCode::kNotConverged);
  EXPECT_EQ(robot->body().materials[0].youngs_modulus_Pa, modulus_Pa);
  job.request.stop = {};
  EXPECT_TRUE(CalibrateLive(*robot, job).status.ok());
}

TEST(LiveCalibration, WhatIsFoundAnewReplacesWhatWas) {
  robot::CalibrationFile before;
  before.moduli = {{"body", 1e5, 1e3}, {"tip", 2e5, 2e3}};
  before.poissons_ratios = {{"body", 0.4, 0.01}};
  before.gravity = robot::CalibratedGravity{{0.0, 0.0, -9.0}, {0.1, 0.1, 0.1}};
  before.pose.emplace().T_robot_camera.translation().x() = 1.0;
  before.geometry_scale = robot::CalibratedScale{1.02, 1e-3};
  before.cable_routes = {{"a", 0, {1e-3, 0.0, 0.0}, {1e-4, 0.0, 0.0}},
                         {"b", 0, {2e-3, 0.0, 0.0}, {1e-4, 0.0, 0.0}},
                         {"b", 2, {4e-3, 0.0, 0.0}, {1e-4, 0.0, 0.0}}};
  before.drives = {{"a", {1e-3, 0.1}, {1e-4, 0.01}}, {"b", {2e-3, 0.2}, {2e-4, 0.02}}};
  robot::CalibrationFile found;
  found.moduli = {{"tip", 3e5, 3e3}};
  found.poissons_ratios = {{"body", 0.3, 0.02}};
  found.gravity = robot::CalibratedGravity{{0.0, 0.0, -9.5}, {0.2, 0.2, 0.2}};
  found.pose.emplace().T_robot_camera.translation().x() = 2.0;
  found.drives = {{"b", {1e-4, 0.1}, {3e-4, 0.03}}};
  found.cable_routes = {{"b", 0, {3e-3, 0.0, 0.0}, {1e-4, 0.0, 0.0}}};
  KeepFromBefore(before, &found);
  EXPECT_EQ(found.geometry_scale->scale, 1.02);
  ASSERT_EQ(found.cable_routes.size(), 3u);
  EXPECT_EQ(found.cable_routes[0].moved_m.x(), 3e-3);
  EXPECT_EQ(found.cable_routes[1].cable, "a");
  EXPECT_EQ(found.cable_routes[2].point, 2);
  ASSERT_EQ(found.moduli.size(), 2u);
  EXPECT_EQ(found.moduli[0].youngs_modulus_Pa, 3e5);
  EXPECT_EQ(found.moduli[1].part, "body");
  ASSERT_EQ(found.poissons_ratios.size(), 1u);
  EXPECT_EQ(found.poissons_ratios[0].poissons_ratio, 0.3);
  EXPECT_EQ(found.gravity->gravity_m_s2.z(), -9.5);
  EXPECT_EQ(found.pose->T_robot_camera.translation().x(), 2.0);
  ASSERT_EQ(found.drives.size(), 2u);
  EXPECT_EQ(found.drives[1].cable, "a");
  EXPECT_EQ(found.drives[1].drive.offset_m, 1e-3);
  // Commanded u, it takes in 1.1 (1.2 u + 2 mm) + 0.1 mm.
  EXPECT_NEAR(found.drives[0].drive.TakenIn_m(0.0), 2.3e-3, 1e-15);
  EXPECT_NEAR(found.drives[0].drive.TakenIn_m(1e-2), 1.32e-2 + 2.3e-3, 1e-15);
  EXPECT_EQ(found.drives[0].standard_error.offset_m, 3e-4);
}

/// Thrusts in frames are readings: corrected by the earlier sensors, and by the new ones at once.
TEST(EarlierCalibration, CorrectsPressuresAndIsComposedWithTheNewOne) {
  const auto arm = force_estimation::Build(test_support::QuickRobot("pneumatic_arm"));
  const robot::ActuatorTraits& chamber = arm->traits(1);
  robot::CalibrationFile before;
  before.pressure_sensors = {{.chamber = chamber.name,
                              .zero_Pa = robot::CalibratedNumber{-100.0, 3.0},
                              .gain = robot::CalibratedNumber{0.25, 0.02}}};
  std::vector<CalibrationFrame> frames(1);
  frames[0].cables = {{Kind::kTension, 1.0}, {Kind::kTension, chamber.Force_N(2e3)}, {}};
  ReadAsBefore(before, *arm, &frames);
  EXPECT_EQ(frames[0].cables[0].value, 1.0) << "its sensor is not calibrated";
  EXPECT_NEAR(chamber.ReportedForce(frames[0].cables[1].value), 2400.0, 1e-9);
  EXPECT_EQ(frames[0].cables[2].kind, Kind::kNone) << "open to the air";
  robot::CalibrationFile found;
  found.pressure_sensors = {
      {.chamber = chamber.name, .zero_Pa = robot::CalibratedNumber{40.0, 2.0}, .gain = {}}};
  KeepFromBefore(before, &found);
  ASSERT_EQ(found.pressure_sensors.size(), 1U);
  EXPECT_NEAR(found.pressure_sensors[0].Pressure_Pa(2e3), 2440.0, 1e-9);
}

}  // namespace
}  // namespace palpate::calibration
