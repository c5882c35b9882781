// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/calibration/joint/unknown.hpp"
#include "libs/geometry/depth_bias_map.hpp"

namespace palpate::calibration {

/// What is believed of the smooth error of a depth image (geometry::DepthBiasMap) before the data
/// are looked at.
struct DepthBiasPrior {
  Belief coefficient;  ///< of each, a share of the distance
  /// Else it stays at its mean, and counts in the standard errors of all that is estimated (a
  /// Schmidt consider covariance).
  bool estimated = true;
  geometry::DepthBiasBasis basis = {};
};

}  // namespace palpate::calibration
