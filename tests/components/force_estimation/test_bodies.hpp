// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "components/force_estimation/marker_force_estimator.hpp"
#include "components/force_estimation/marker_frame.hpp"
#include "libs/robot/robot_body.hpp"
#include "libs/robot/robot_model.hpp"
#include "tests/support/robots.hpp"

namespace palpate::force_estimation {

/// Robots of config/robots with linear elements (quick to solve) and as many markers as a test
/// needs, and truths that RobotModel::Solve makes for them.

using Kind = robot::ActuatorCommand::Kind;
using test_support::QuickFourLegRobot;

/// The clamped beam with twelve markers on top and sides, and without a cable: 1 N at the tip moves
/// it by about 15 mm.
inline robot::RobotDescription BeamRobot() {
  robot::RobotDescription robot = test_support::QuickRobot("beam");
  robot.markers.clear();
  for (const double x : {-0.075, -0.05, -0.025, 0.0}) {
    const std::array<Eigen::Vector3d, 3> around = {Eigen::Vector3d(x, 0.015, 0.03),
                                                   Eigen::Vector3d(x, 0.0, 0.015),
                                                   Eigen::Vector3d(x, 0.03, 0.015)};
    for (const Eigen::Vector3d& position_m : around) {
      robot.markers.push_back({"m" + std::to_string(robot.markers.size()), position_m, {}});
    }
  }
  robot.feature_point_count = 24;
  return robot;
}

inline std::unique_ptr<robot::RobotModel> Build(const robot::RobotDescription& robot) {
  return std::make_unique<robot::RobotModel>(robot::BuildRobotBody(robot),
                                             fem::StaticSettings{.relative_tolerance = 1e-12});
}

inline robot::DeadLoad LoadAt(const robot::RobotModel& model, const Eigen::Vector3d& position_m,
                              double patch_radius_m, const Eigen::Vector3d& force_N) {
  return {model.Patch(position_m, patch_radius_m).weights, force_N};
}

inline fem::StaticState SolveTruth(robot::RobotModel& model,
                                   const std::vector<robot::ActuatorCommand>& cables,
                                   const std::vector<robot::DeadLoad>& loads) {
  fem::StaticState state = model.RestState();
  const fem::StaticResult result = model.Solve(cables, loads, &state);
  EXPECT_TRUE(result.status.ok()) << ToString(result.status.code()) << result.status.message();
  return state;
}

/// All markers where the state has them, without noise.
inline MarkerFrame FrameOf(const robot::RobotModel& model, const fem::StaticState& state,
                           const std::vector<robot::ActuatorCommand>& cables,
                           double sigma_m = 1e-4) {
  MarkerFrame frame;
  for (const robot::BodyMarker& marker : model.body().markers) {
    frame.markers.push_back({.valid = true,
                             .position_m = marker.point.weights.Position(state.x_m),
                             .sigma_m = Eigen::Vector3d::Constant(sigma_m)});
  }
  frame.cables = cables;
  return frame;
}

inline MarkerFrame FrameUnder(robot::RobotModel& model,
                              const std::vector<robot::ActuatorCommand>& cables,
                              const std::vector<robot::DeadLoad>& loads) {
  return FrameOf(model, SolveTruth(model, cables, loads), cables);
}

inline Eigen::Vector3d NormalNoise(double sigma_m, std::mt19937& random) {
  std::normal_distribution<double> normal(0.0, sigma_m);
  const double x = normal(random);
  const double y = normal(random);
  return {x, y, normal(random)};
}

inline void AddNoise(double sigma_m, std::mt19937& random, MarkerFrame* frame) {
  for (MarkerObservation& marker : frame->markers) {
    marker.position_m += NormalNoise(sigma_m, random);
  }
}

inline Config WithContacts(const std::vector<std::string>& contacts) {
  Config config;
  config.contacts = contacts;
  return config;
}

}  // namespace palpate::force_estimation
