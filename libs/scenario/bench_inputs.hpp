// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "libs/scenario/scenario.hpp"

namespace palpate::scenario {

/// A tool at one instant.
struct ToolPose {
  std::string tool;
  Eigen::Isometry3d T_robot_tool = Eigen::Isometry3d::Identity();
};

/// What is done to the robot at one instant.
struct BenchInputs {
  /// [actuators of the robot file] commands: displacements of the cables, m (NaN: the cable is
  /// free), then pressures of the chambers above ambient, Pa (NaN: open to the air).
  Eigen::VectorXd displacement_m;
  std::vector<ToolPose> tools;      ///< those that are there
  std::vector<HungWeight> weights;  ///< those that hang now
  Eigen::Vector2d base_tilt_deg = Eigen::Vector2d::Zero();
};

}  // namespace palpate::scenario
