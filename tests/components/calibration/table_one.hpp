// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/SVD>
#include <memory>
#include <string>
#include <vector>

#include "components/calibration/pose/alternating_pose_calibration.hpp"
#include "libs/geometry/rigid_transform.hpp"
#include "libs/robot/robot_body.hpp"
#include "libs/robot/robot_model.hpp"
#include "tests/support/robots.hpp"

namespace palpate::calibration {

/// Cable forces of the paper's Table I, N.
inline const Eigen::Vector4d kTableOneForces_N(1.2, 1.0, 1.0, 1.2);

/// Pose of the paper's Table I; R is printed with three digits: the nearest rotation.
inline geometry::RigidTransform TableOnePose() {
  Eigen::Matrix3d printed;
  printed << -0.147, 0.941, 0.305, -0.485, 0.200, -0.851, -0.862, -0.273, 0.427;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(printed, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {Eigen::Matrix3d(svd.matrixU() * svd.matrixV().transpose()),
          Eigen::Vector3d(-0.264956, 0.263885, 0.012767)};
}

using test_support::FourLegRobot;
using test_support::QuickFourLegRobot;

inline std::unique_ptr<robot::RobotModel> Build(const robot::RobotDescription& robot) {
  return std::make_unique<robot::RobotModel>(robot::BuildRobotBody(robot),
                                             fem::StaticSettings{.relative_tolerance = 1e-12});
}

inline fem::StaticState SolveTensions(robot::RobotModel& model, const Eigen::VectorXd& tension_N) {
  std::vector<robot::ActuatorCommand> commands;
  for (const double value : tension_N) {
    commands.push_back({robot::ActuatorCommand::Kind::kTension, value});
  }
  fem::StaticState state = model.RestState();
  const fem::StaticResult result = model.Solve(commands, {}, &state);
  EXPECT_TRUE(result.status.ok()) << result.status.message();
  return state;
}

/// What a camera at this pose sees of these markers, without noise.
inline std::vector<MarkerSighting> Sight(const robot::RobotModel& model,
                                         const fem::StaticState& state,
                                         const geometry::RigidTransform& T_robot_camera,
                                         const std::vector<int>& markers, double sigma_m = 1e-4) {
  std::vector<MarkerSighting> sightings;
  for (const int marker : markers) {
    const auto& weights = model.body().markers.at(static_cast<size_t>(marker)).point.weights;
    sightings.push_back({.marker = marker,
                         .position_m = T_robot_camera.Inverse() * weights.Position(state.x_m),
                         .covariance_m2 = sigma_m * sigma_m * Eigen::Matrix3d::Identity()});
  }
  return sightings;
}

using test_support::DiamondWithMarkers;

/// Of the four legs: the tip and one on each leg, far apart; and all.
inline const std::vector<int> kFiveMarkers = {0, 5, 6, 7, 8};
inline const std::vector<int> kNineMarkers = {0, 1, 2, 3, 4, 5, 6, 7, 8};

}  // namespace palpate::calibration
