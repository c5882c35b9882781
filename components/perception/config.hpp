// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "components/perception/color_config.hpp"
#include "components/perception/contact_config.hpp"
#include "components/perception/fiducial_config.hpp"
#include "components/perception/model_config.hpp"
#include "components/perception/texture_config.hpp"
#include "libs/core/config_reader.hpp"
#include "libs/rgbd/depth_noise.hpp"

namespace palpate::perception {

/// Settings that all parts of perception share, and those of each.
struct Config {
  std::string segmentation = "model";
  double min_z_m = 0.1;
  double max_z_m = 2.0;
  int max_cloud_points = 10000;
  std::vector<double> robot_color_rgb;
  double depth_subpixel_px = 0.08;
  double depth_range_sigma_m = 1e-3;
  double depth_correlation_px = 1.5;
  ColorConfig color;
  ContactConfig contacts;
  TrackingConfig tracking;
  ModelConfig model;
  TextureConfig texture;
  FiducialConfig markers;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("segmentation", segmentation, {"model", "color"},
      "model: predicted surface, colour model and depth edges; color: the paper's colour-based "
      "region growing");
    v("min_z_m", min_z_m, {.min = 0.0, .min_open = true}, "Smallest z of points that are used");
    v("max_z_m", max_z_m, {.min = 0.0, .min_open = true}, "Largest z of points that are used");
    v("robot_color_rgb", robot_color_rgb, {.min = 0.0, .max = 1.0},
      "Red, green, blue of the robot: model starts with it and updates it, color keeps it; empty: "
      "estimated from the frames");
    v("max_cloud_points", max_cloud_points, {.min = 100.0, .max = 10000.0},
      "Largest number of points of each published cloud (20 bytes each)");
    v("depth_subpixel_px", depth_subpixel_px, {.min = 0.0, .min_open = true},
      "Standard deviation of the disparity where the camera does not report it");
    v("depth_range_sigma_m", depth_range_sigma_m, {.min = 0.0, .min_open = true},
      "Standard deviation of z of cameras without a baseline");
    v("depth_correlation_px", depth_correlation_px, {.min = 0.0, .max = 50.0},
      "Correlation length of the depth error over neighbouring pixels");
    v("color", color, "Segmentation by colour, as in the paper");
    v("contacts", contacts, "Contact location");
    v("tracking", tracking, "Contact tracking");
    v("model", model, "Segmentation by the predicted surface");
    v("texture", texture, "Points of the robot's texture");
    v("markers", markers, "Coloured discs on the robot");
  }
};

/// Noise of the depth image, where the camera does not report it.
rgbd::DepthNoise NoiseOf(const Config& config);

/// Settings of the markers with those that all parts share.
FiducialConfig FiducialsOf(const Config& config);

/// robot_color_rgb, or nothing where it is empty. Throws InputError where it is no colour.
std::optional<Eigen::Vector3d> RobotColor(const Config& config);

}  // namespace palpate::perception
