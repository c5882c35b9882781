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
      "Red, green, blue of the markers, one triple per colour; empty: no marker detection");
    v("names", names,
      "Marker name of each colour, where no two markers share one; empty: palpate calibrate or "
      "palpate-calibration assigns names by position");
    v("color_tolerance", color_tolerance, {.min = 0.0, .max = 1.0, .min_open = true},
      "Largest distance of a marker pixel from its colour; colours are unit vectors, so that "
      "shading has no effect");
    v("min_contrast", min_contrast, {.min = 0.0, .max = 1.4},
      "Smallest colour distance of a marker from its surroundings");
    v("min_brightness", min_brightness, {.min = 0.0, .max = 1.0},
      "Smallest brightness (strongest channel) of pixels whose colour is used");
    v("min_radius_m", min_radius_m, positive, "Radius of the smallest marker");
    v("max_radius_m", max_radius_m, positive, "Radius of the largest marker");
    v("size_tolerance", size_tolerance, {.min = 0.0, .max = 1.0},
      "Relative tolerance of min_radius_m and max_radius_m");
    v("shape_tolerance", shape_tolerance, {.min = 0.0, .max = 1.0},
      "Relative tolerance of a marker's axes on the surface, and of its area against their "
      "ellipse");
    v("max_open_rim", max_open_rim, {.min = 0.0, .max = 1.0},
      "Largest share of a marker's rim that does not border on its own surface");
    v("min_pixels", min_pixels, {.min = 1.0}, "Smallest number of pixels of a marker");
    v("rim_sigma_px", rim_sigma_px, {.min = 0.0},
      "Standard deviation of a marker's image position by lens, sampling and texture at its rim, "
      "beside the noise");
    v("depth_bias", depth_bias, {.min = 0.0, .max = 0.1},
      "Standard deviation of the common depth error about a marker, as a share of z");
    v("bend_radius_m", bend_radius_m, positive,
      "Radius of curvature of the surface, one standard deviation");
  }
};

}  // namespace palpate::perception
