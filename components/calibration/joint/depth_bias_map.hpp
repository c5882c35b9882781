// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "components/calibration/joint/unknown.hpp"

namespace palpate::calibration {

/// A depth image that errs smoothly over the picture, as stereo cameras do by 0.2 to 0.5 % of z: a
/// point measured at p (camera frame) is at (1 + b) p, b a polynomial in x / (z span), y / (z
/// span).
struct DepthBiasBelief {
  Belief coefficient;  ///< of each, a share of the distance
  /// A slope of it looks much like a turn of the camera. Where it is not estimated it stays at its
  /// mean, and counts in the standard errors of all that is (a Schmidt consider covariance).
  bool estimated = true;
  int order = 2;       ///< 0: the same everywhere
  double span = 0.25;  ///< tangent of the angle over which it may change by about its sigma
};

/// How many coefficients.
int CountOf(const DepthBiasBelief& belief);

/// "depth_scale" (the constant), "depth_bias:x", "depth_bias:y", "depth_bias:xx", ...
std::vector<std::string> NamesOf(const DepthBiasBelief& belief);

/// What each coefficient is multiplied with, 1 first; p with z > 0.
Eigen::VectorXd DepthBiasBasis(const DepthBiasBelief& belief, const Eigen::Vector3d& p_camera_m);

}  // namespace palpate::calibration
