// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

namespace palpate::calibration {

/// Where a load acts, in metres on the undeformed robot, robot frame: on one that is larger than
/// the model another part of the body is there.
struct LoadPlace {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  double patch_radius_m = 0.0;  ///< 0: a point
};

}  // namespace palpate::calibration
