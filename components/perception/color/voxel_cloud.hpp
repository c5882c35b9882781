// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "components/perception/color/large_planes.hpp"
#include "components/perception/config.hpp"
#include "components/perception/observation.hpp"
#include "components/perception/registered_frame.hpp"
#include "libs/core/index.hpp"
#include "libs/geometry/box.hpp"

namespace palpate::perception {

/// A coloured cloud of which each point is the mean of a voxel's pixels.
struct VoxelCloud {
  double voxel_m = 0.0;                  ///< edge
  Eigen::Matrix3Xf points_m;             ///< [3 x n] camera frame
  std::vector<std::uint8_t> colors_rgb;  ///< [3 n]
  std::vector<int> pixels;               ///< [n] in each

  int Count() const { return static_cast<int>(pixels.size()); }
  Eigen::Vector3d Color(int point) const {
    const std::uint8_t* rgb = colors_rgb.data() + 3 * ToIndex(point);
    return {static_cast<double>(rgb[0]), static_cast<double>(rgb[1]), static_cast<double>(rgb[2])};
  }
};

struct VoxelCloudTuning {
  LargePlanesTuning planes = {};
  /// Distance of a plane's points, in sigmas of the depth. Larger: objects on a table lose their
  /// lower rim; smaller: far planes leave points.
  float noise_sigmas = 4.0f;
};

/// The paper's filters, by PCL: unprojection of the whole image, PassThrough in z, x and y to
/// `box`, removal of table and walls, VoxelGrid, RadiusOutlierRemoval. At most `max_cloud_points`
/// remain: the voxels grow until then. Pixels of unknown colour are left out. Counts pixels in
/// `rejected`.
VoxelCloud FilterFrame(const RegisteredFrame& frame, const Registration& registration,
                       const geometry::Box& box, const Config& config, Rejections* rejected,
                       const VoxelCloudTuning& tuning = {});

}  // namespace palpate::perception
