// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

namespace palpate::calibration {

/// Where a load acts, m, undeformed robot, robot frame. It stays there when the size of the robot
/// is estimated: another part of the body is then at that place.
struct LoadPlace {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  double patch_radius_m = 0.0;  ///< 0: a point
};

}  // namespace palpate::calibration
