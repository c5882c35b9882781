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
      "So far round the predicted surface the frame is looked at");
    v("object_distance_m", object_distance_m, {.min = 0.0, .max = 1.0},
      "Objects farther from the robot are left out");
    v("surface_sigma_m", surface_sigma_m, {.min = 0.0, .min_open = true},
      "Sigma of the predicted surface once it is fitted to the frame");
    v("largest_error_m", largest_error_m, {.min = 0.0, .min_open = true},
      "Farther the predicted surface is not moved to fit the frame");
    v("fit_spacing_m", fit_spacing_m, {.min = 0.02},
      "Over which the error of the predicted surface changes");
    v("background_bias", background_bias, {.min = 0.0, .max = 0.1},
      "Share of z by which the depth of a plane behind the robot may be bent");
    v("color_update", color_update, {.min = 0.0, .max = 1.0, .min_open = true},
      "Share of a frame in the learnt colours");
    v("min_robot_pixels", min_robot_pixels, {.min = 1.0},
      "With fewer pixels of it the robot is not seen");
  }
};

}  // namespace palpate::perception
