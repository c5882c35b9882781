// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "components/calibration/joint/joint_calibration.hpp"
#include "components/calibration/joint/route_unknowns.hpp"
#include "libs/robot/eyelets.hpp"
#include "tests/components/calibration/table_one.hpp"
#include "tests/components/force_estimation/test_bodies.hpp"

namespace palpate::calibration {

using force_estimation::Kind;

inline geometry::RigidTransform Disturbed(const geometry::RigidTransform& T, double turn_rad,
                                          double shift_m) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1.0, -2.0, 0.5).normalized();
  return {Eigen::Quaterniond(Eigen::AngleAxisd(turn_rad, axis)) * T.rotation(),
          T.translation_m() + shift_m * Eigen::Vector3d(0.6, 0.0, -0.8)};
}

inline std::vector<robot::ActuatorCommand> Commands(Kind kind, const std::vector<double>& values) {
  std::vector<robot::ActuatorCommand> commands;
  for (const double value : values) commands.push_back({kind, value});
  return commands;
}

/// A model whose cables' eyelets can be moved.
inline std::unique_ptr<robot::RobotModel> BuildWithRoom(const robot::RobotDescription& robot,
                                                        double eyelet_room_m) {
  robot::RobotBody body = robot::BuildRobotBody(robot);
  robot::GiveEyeletsRoom(eyelet_room_m, &body);
  return std::make_unique<robot::RobotModel>(std::move(body));
}

/// What a camera at `T_robot_camera` sees of `model` as it is now.
inline CalibrationFrame See(robot::RobotModel& model,
                            const geometry::RigidTransform& T_robot_camera, const std::string& name,
                            const std::vector<robot::ActuatorCommand>& commands,
                            const std::vector<robot::DeadLoad>& loads, double sigma_m,
                            std::mt19937_64* random = nullptr) {
  const fem::StaticState state = force_estimation::SolveTruth(model, commands, loads);
  CalibrationFrame frame{
      .name = name, .cables = commands, .loads = loads, .gravity_m_s2 = model.gravity_m_s2()};
  std::vector<int> all(model.body().markers.size());
  std::iota(all.begin(), all.end(), 0);
  frame.markers = Sight(model, state, T_robot_camera, all, sigma_m);
  std::normal_distribution<double> noise(0.0, sigma_m);
  for (MarkerSighting& sighting : frame.markers) {
    if (random == nullptr) break;
    for (int i = 0; i < 3; ++i) sighting.position_m[i] += noise(*random);
  }
  return frame;
}

inline void ExpectPose(const geometry::RigidTransform& found,
                       const geometry::RigidTransform& expected, double turn_rad, double shift_m) {
  EXPECT_LE(found.rotation().angularDistance(expected.rotation()), turn_rad);
  EXPECT_LE((found.translation_m() - expected.translation_m()).norm(), shift_m);
}

inline const FittedValue* ValueNamed(const JointCalibration& fit, const std::string& name) {
  for (const FittedValue& value : fit.values) {
    if (value.name == name) return &value;
  }
  ADD_FAILURE() << name << " was not fitted";
  return nullptr;
}

}  // namespace palpate::calibration
