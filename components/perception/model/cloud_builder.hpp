// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "components/perception/model/pixel_region.hpp"
#include "components/perception/registered_frame.hpp"
#include "libs/rgbd/depth_noise.hpp"
#include "libs/rgbd/sensed_cloud.hpp"

namespace palpate::perception {

/// Builds clouds of the pixels of one label: averages blocks of neighbouring pixels without a depth
/// edge, as large as the cloud's limit requires, so that all measurements are used.
class CloudBuilder {
 public:
  CloudBuilder(const rgbd::DepthNoise& noise, int max_points)
      : noise_(noise), max_points_(max_points) {}

  /// Returns how many pixels were averaged into others.
  std::int64_t Build(const Registration& registration, const RegisteredFrame& frame,
                     const PixelRegion& region, Label label, rgbd::SensedCloud* cloud);

 private:
  struct Group {
    float first_z_m = 0.0f;
    int count = 0;
    Eigen::Vector3f sum_m = Eigen::Vector3f::Zero();
    Eigen::Vector3i sum_rgb = Eigen::Vector3i::Zero();
  };

  struct Bounds {
    int left = 0;
    int top = 0;
    int right = 0;
    int bottom = 0;
  };

  std::int64_t FindBounds(const PixelRegion& region, Label label);
  void GroupBlocks(const Registration& registration, const RegisteredFrame& frame,
                   const PixelRegion& region, Label label, int block_px2);
  void AddPixel(const Eigen::Vector3f& point_m, float step_m, const std::uint8_t* rgb,
                std::size_t first_of_block);
  void Write(const rgbd::RgbdCamera& camera, rgbd::SensedCloud* cloud) const;

  rgbd::DepthNoise noise_;
  int max_points_;
  Bounds bounds_;
  std::vector<Group> groups_;
};

}  // namespace palpate::perception
