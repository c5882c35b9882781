// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "libs/robot/robot_model.hpp"

namespace palpate::command {

/// A ball that is pressed against the surface along its normal. Places of its centre, robot frame.
struct Touch {
  Eigen::Vector3d away_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d near_m = Eigen::Vector3d::Zero();  ///< just before it touches
  Eigen::Vector3d pressed_m = Eigen::Vector3d::Zero();
  double force_N = 0.0;  ///< of the normal push that moves the surface so far, about
};

/// What the actuators do: of a cable m pulled in, of a chamber Pa above ambient.
struct ActuatorSetting {
  std::string name;
  bool is_chamber = false;
  double value = 0.0;
};

/// Where a camera stands, and how balls touch a robot, all of it by the robot's size and stiffness.
struct TouchPlan {
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
  double ball_radius_m = 0.0;
  Touch visible;
  /// On the side that the camera does not see. Absent: no such place can be reached.
  std::optional<Touch> hidden;
  /// Second of two at once, beside `visible`. Absent: no two places are far enough apart.
  std::optional<Touch> second;
  /// Of a robot with actuators: a posture, and a touch in it.
  std::vector<ActuatorSetting> settings;  ///< in the order of the actuators
  std::optional<Touch> driven;
};

/// What moves most under a touch moves by `kTouchMotion` of the body's diagonal, by
/// `kLongTouchMotion` where the body is long, because it bends away; under the actuators by
/// `kDrivenMotion`.
inline constexpr double kTouchMotion = 0.03;
inline constexpr double kLongTouchMotion = 0.08;
inline constexpr double kDrivenMotion = 0.08;

/// Throws InputError where the robot has no equilibrium under gravity, or no place on the side of
/// the camera that a ball can press.
TouchPlan PlanTouches(robot::RobotModel* model);

}  // namespace palpate::command
