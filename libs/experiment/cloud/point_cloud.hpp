// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "libs/rgbd/rgbd_camera.hpp"
#include "libs/rgbd/rgbd_frame.hpp"

namespace palpate::experiment {

/// A cloud as a PCD or PLY file has it. Points are in metres, in the frame of the file (the depth
/// camera's optical frame in a recording).
struct PointCloud {
  /// Organised: points of the image, row by row from the top, width * height of them. Not:
  /// height 1.
  int width = 0;
  int height = 1;
  Eigen::Matrix3Xd points_m;             ///< [3 x n]; NaN (all three): nothing seen in this pixel
  std::vector<std::uint8_t> colors_rgb;  ///< [3 n], or empty: none

  bool organised() const { return height > 1; }
};

/// Reads .pcd and .ply by the extension (ReadPcd, ReadPly); throws InputError for any other.
PointCloud ReadPointCloud(const std::filesystem::path& file);

/// The depth image that the camera would have given for the cloud: pixel for pixel where it is
/// organised and as large as the image, else each point in the pixel where it is seen, the nearest
/// one winning. Points behind the camera, outside the image or farther than the depth values reach
/// are left out. Colour where the cloud has any and the camera's is registered to depth.
rgbd::RgbdFrame FrameFromCloud(const PointCloud& cloud, const rgbd::RgbdCamera& camera);

}  // namespace palpate::experiment
