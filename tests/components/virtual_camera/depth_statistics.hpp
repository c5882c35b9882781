// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <array>

#include "libs/rgbd/image.hpp"

namespace palpate::virtual_camera {

/// What a depth image of a stereo-like camera looks like, in numbers that do not depend on what it
/// shows.
struct DepthStatistics {
  double valid = 0.0;  ///< share of pixels

  /// Of flat patches, without the plane that fits best, px of disparity.
  int patches = 0;
  double plane_sigma_px = 0.0;             ///< median over the patches
  std::array<double, 5> correlation = {};  ///< at 0 .. 4 px, across and down

  /// Of holes that neither touch the border nor are larger than 5 % of the image.
  int holes = 0;             ///< connected regions
  double hole_pixels = 0.0;  ///< share of the pixels
  double at_edges = 0.0;     ///< share of these that lie in holes across a depth edge
  double single = 0.0;       ///< share of the holes of one or two pixels
  /// Steps of 8 px and more from one pixel that is seen to the next in its row, and the holes
  /// between over the step, median: of steps up added to that of steps down. A shadow of the other
  /// imager gives 1, on one side; seen from between the imagers, on both sides together.
  int steps = 0;
  double shadow_width = 0.0;
};

/// `focal_baseline_px_m`: disparity is that divided by z.
DepthStatistics StatisticsOf(const rgbd::RangeImage& range, double focal_baseline_px_m);

}  // namespace palpate::virtual_camera
