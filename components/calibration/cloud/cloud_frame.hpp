// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "libs/rgbd/sensed_cloud.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// Clouds of the robot at rest at one setting of its cables, and the known inputs. Points of other
/// objects (tools, base, table) are allowed, colours are not used.
struct CloudFrame {
  std::string name;  ///< for messages
  /// Of the first camera, in its frame; empty where only further ones see the robot.
  rgbd::SensedCloud cloud;
  /// [CloudSettings::further_cameras] of these, each in its frame; empty: it does not see the
  /// robot. None at all: no further camera does.
  std::vector<rgbd::SensedCloud> further = {};
  std::vector<robot::ActuatorCommand> cables = {};  ///< one for each cable; kNone: unknown tension
  std::vector<robot::DeadLoad> loads = {};
  Eigen::Vector3d gravity_m_s2 = Eigen::Vector3d::Zero();  ///< robot frame
};

}  // namespace palpate::calibration
