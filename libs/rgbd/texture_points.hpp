// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace palpate::rgbd {

/// Points of the robot's texture that a colour camera follows over the frames, one entry each.
/// Each is a line of sight on which the material point lies. Depth camera's frame.
struct TexturePoints {
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();  ///< centre of the colour camera
  std::vector<std::uint64_t> ids;  ///< the same over the frames, and never of another point
  Eigen::Matrix3Xf directions;     ///< [3 x n] unit
  Eigen::VectorXf sigma_rad;       ///< [n] of each component across the line of sight, > 0

  Eigen::Index Count() const { return directions.cols(); }
};

}  // namespace palpate::rgbd
