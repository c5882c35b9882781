// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/config.hpp"

#include "libs/core/error.hpp"

namespace palpate::perception {

rgbd::DepthNoise NoiseOf(const Config& config) {
  return {.subpixel_px = config.depth_subpixel_px,
          .range_sigma_m = config.depth_range_sigma_m,
          .correlation_px = config.depth_correlation_px};
}

FiducialConfig FiducialsOf(const Config& config) {
  FiducialConfig markers = config.markers;
  markers.min_z_m = config.min_z_m;
  markers.max_z_m = config.max_z_m;
  markers.noise = NoiseOf(config);
  return markers;
}

std::optional<Eigen::Vector3d> RobotColor(const Config& config) {
  const std::vector<double>& rgb = config.robot_color_rgb;
  if (rgb.empty()) return std::nullopt;
  if (rgb.size() != 3) {
    throw InputError("robot_color_rgb has " + std::to_string(rgb.size()) +
                     " numbers; must have three, or none");
  }
  return Eigen::Vector3d(rgb[0], rgb[1], rgb[2]);
}

}  // namespace palpate::perception
