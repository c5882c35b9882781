// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/calibration/joint/unknown.hpp"
#include "libs/geometry/depth_bias_map.hpp"

namespace palpate::calibration {

/// Prior of the depth bias (geometry::DepthBiasMap).
struct DepthBiasPrior {
  GaussianPrior coefficient;  ///< of each coefficient, a share of the distance
  /// Otherwise it stays at its mean and is considered in the covariance of the estimates
  /// (Schmidt 1966).
  bool estimated = true;
  geometry::DepthBiasBasis basis = {};
};

}  // namespace palpate::calibration
