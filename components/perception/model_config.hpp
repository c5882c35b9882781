// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/core/config_reader.hpp"

namespace palpate::perception {

/// Settings of the segmentation by the predicted surface.
struct ModelConfig {
  double margin_m = 0.06;
  double object_distance_m = 0.05;
  double surface_sigma_m = 1.2e-3;
  double largest_error_m = 0.015;
  double fit_spacing_m = 0.07;
  double background_bias = 0.006;
  double color_update = 0.1;
  int min_robot_pixels = 200;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("margin_m", margin_m, {.min = 0.0, .max = 1.0},
      "Width of the region of interest around the predicted surface");
    v("object_distance_m", object_distance_m, {.min = 0.0, .max = 1.0},
      "Largest distance of an object from the robot");
    v("surface_sigma_m", surface_sigma_m, {.min = 0.0, .min_open = true},
      "Standard deviation of the predicted surface after its fit to the frame");
    v("largest_error_m", largest_error_m, {.min = 0.0, .min_open = true},
      "Largest correction of the predicted surface by its fit to the frame");
    v("fit_spacing_m", fit_spacing_m, {.min = 0.02},
      "Correlation length of the error of the predicted surface");
    v("background_bias", background_bias, {.min = 0.0, .max = 0.1},
      "Largest depth error of a background plane, as a share of z");
    v("color_update", color_update, {.min = 0.0, .max = 1.0, .min_open = true},
      "Weight of one frame in the update of the colour model");
    v("min_robot_pixels", min_robot_pixels, {.min = 1.0},
      "Smallest number of robot pixels; below it the status is no_robot_seen");
  }
};

}  // namespace palpate::perception
