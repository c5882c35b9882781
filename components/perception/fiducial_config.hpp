// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "libs/core/config_reader.hpp"
#include "libs/rgbd/depth_noise.hpp"

namespace palpate::perception {

/// What the coloured discs on the robot look like.
struct FiducialConfig {
  std::vector<double> color_rgb;
  std::vector<std::string> names;
  double color_tolerance = 0.3;
  double min_contrast = 0.35;
  double min_brightness = 0.08;
  double min_radius_m = 0.002;
  double max_radius_m = 0.004;
  double size_tolerance = 0.25;
  double shape_tolerance = 0.3;
  double max_open_rim = 0.3;
  int min_pixels = 6;
  double rim_sigma_px = 0.05;
  double depth_bias = 0.003;
  double bend_radius_m = 0.015;
  // Those of Config, which holds them for all of perception.
  double min_z_m = 0.1;
  double max_z_m = 2.0;
  rgbd::DepthNoise noise = {};

  template <typename Visitor>
  void Visit(Visitor&& v) {
    constexpr NumberRule positive{.min = 0.0, .min_open = true};
    v("color_rgb", color_rgb, {.min = 0.0, .max = 1.0},
      "Red, green, blue of the markers; of several colours one after the other; empty: the robot "
      "has none, and they are not looked for");
    v("names", names,
      "The robot's marker of each of these colours, where no two have the same; empty: who is who "
      "is told by where they are (palpate calibrate, palpate-calibration)");
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
    v("rim_sigma_px", rim_sigma_px, {.min = 0.0},
      "Sigma of a marker's place in the image by what lens, sampling and the skin's own pattern "
      "make of its rim, beside the noise");
    v("depth_bias", depth_bias, {.min = 0.0, .max = 0.1},
      "Sigma, as a share of z, of what all depths about a marker err by alike");
    v("bend_radius_m", bend_radius_m, positive, "How sharply the skin bends, one sigma");
  }
};

}  // namespace palpate::perception
