// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/perception/color_config.hpp"

namespace palpate::perception {

struct LargePlanesTuning {
  std::size_t most_planes = 3;  ///< more: slower, smaller planes are removed
  int most_tries = 6;           ///< including planes that are refused; more: slower
  int ransac_iterations = 200;  ///< more: slower, planes are missed less often
  /// Share of all points on a plane. Smaller: flat objects count as background.
  double least_share = 0.2;
  /// RMS distance of a plane's points, in thicknesses; 0.58 where it cuts through something.
  /// Larger: slices of objects count as planes.
  double flat_thicknesses = 0.5;
};

/// Table and walls: (n, d) with n . p + d = 0 and |n| = 1 of the planes that contain a large share
/// of the points [3 x n] over at least background_extent_m, found by RANSAC (PCL's; the same points
/// give the same planes).
std::vector<Eigen::Vector4f> FindLargePlanes(const Eigen::Matrix3Xf& points_m,
                                             const ColorConfig& config,
                                             const LargePlanesTuning& tuning = {});

}  // namespace palpate::perception
