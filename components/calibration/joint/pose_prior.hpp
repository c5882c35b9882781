// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "components/calibration/joint/camera_view.hpp"
#include "libs/geometry/rigid_transform.hpp"

namespace palpate::calibration {

/// A pose that was measured: the mean of a Gaussian prior of its PoseChange.
struct PosePrior {
  std::string name;  ///< for messages
  geometry::RigidTransform T_robot_camera;
  double translation_sigma_m = 0.0;  ///< > 0, along each axis of the robot frame
  double rotation_sigma_rad = 0.0;   ///< > 0, about each axis
};

/// A pose with a prior after the fit.
struct AdjustedPose {
  std::string name;
  geometry::RigidTransform T_robot_camera;
  PoseChange from_prior = PoseChange::Zero();  ///< rad, m
  double chi_squared = 0.0;                    ///< of `from_prior`, six degrees of freedom
};

}  // namespace palpate::calibration
