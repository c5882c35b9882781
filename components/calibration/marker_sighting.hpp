// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

namespace palpate::calibration {

/// A marker as the camera sees it.
struct MarkerSighting {
  int marker = -1;                                       ///< index into RobotBody::markers
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< camera frame
  /// Of the position and of the model there, camera frame; positive definite.
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
};

}  // namespace palpate::calibration
