// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "libs/core/config_reader.hpp"

namespace palpate::perception {

/// What the coloured discs on the robot look like.
struct FiducialConfig {
  std::vector<double> color_rgb;
  double color_tolerance = 0.3;
  double min_contrast = 0.35;
  double min_brightness = 0.08;
  double min_radius_m = 0.002;
  double max_radius_m = 0.004;
  double size_tolerance = 0.25;
  double shape_tolerance = 0.3;
  double max_open_rim = 0.3;
  int min_pixels = 6;
  double min_z_m = 0.1;
  double max_z_m = 2.0;
  double rim_sigma_px = 0.05;
  double depth_bias = 0.003;
  double bend_radius_m = 0.015;
  double depth_subpixel_px = 0.08;
  double depth_range_sigma_m = 1e-3;
  double depth_correlation_px = 1.5;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    constexpr NumberRule positive{.min = 0.0, .min_open = true};
    v("color_rgb", color_rgb, {.min = 0.0, .max = 1.0},
      "Red, green, blue of the markers; of several colours one after the other");
    v("color_tolerance", color_tolerance, {.min = 0.0, .max = 1.0, .min_open = true},
      "A pixel differs so little from that colour; colours as directions, so that shading does "
      "not count");
    v("min_contrast", min_contrast, {.min = 0.0, .max = 1.4},
      "A marker differs at least so much from what is round it, likewise");
    v("min_brightness", min_brightness, {.min = 0.0, .max = 1.0},
      "Darker pixels (strongest channel) have no colour");
    v("min_radius_m", min_radius_m, positive, "Of the smallest marker");
    v("max_radius_m", max_radius_m, positive, "Of the largest marker");
    v("size_tolerance", size_tolerance, {.min = 0.0, .max = 1.0},
      "Share by which a marker may look smaller or larger than that");
    v("shape_tolerance", shape_tolerance, {.min = 0.0, .max = 1.0},
      "Share by which its axes may differ on the skin, and its area from their ellipse");
    v("max_open_rim", max_open_rim, {.min = 0.0, .max = 1.0},
      "Share of its rim that may border on something else than the skin it is on");
    v("min_pixels", min_pixels, {.min = 1.0}, "Smaller spots are too small");
    v("min_z_m", min_z_m, positive, "Nearer spots are left out");
    v("max_z_m", max_z_m, positive, "Farther spots are left out");
    v("rim_sigma_px", rim_sigma_px, {.min = 0.0},
      "Sigma of a marker's place in the image by what lens, sampling and the skin's own pattern "
      "make of its rim, beside the noise");
    v("depth_bias", depth_bias, {.min = 0.0, .max = 0.1},
      "Sigma, as a share of z, of what all depths about a marker err by alike");
    v("bend_radius_m", bend_radius_m, positive, "How sharply the skin bends, one sigma");
    v("depth_subpixel_px", depth_subpixel_px, positive, "Sigma of the disparity");
    v("depth_range_sigma_m", depth_range_sigma_m, positive,
      "Sigma of z of cameras without a baseline");
    v("depth_correlation_px", depth_correlation_px, {.min = 0.0, .max = 50.0},
      "Over which neighbouring pixels err alike");
  }
};

}  // namespace palpate::perception
