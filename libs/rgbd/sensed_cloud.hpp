// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace palpate::rgbd {

/// Points that a depth camera saw, one column or entry each, in single precision as they travel
/// between processes. Camera frame unless said otherwise.
struct SensedCloud {
  Eigen::Matrix3Xf points_m;             ///< [3 x n] finite
  Eigen::VectorXf sigma_m;               ///< [n] sigma of z (along the optical axis), > 0
  std::vector<std::uint8_t> colors_rgb;  ///< [3 n]

  Eigen::Index Count() const { return points_m.cols(); }
};

}  // namespace palpate::rgbd
