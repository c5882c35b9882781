// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "libs/core/config_reader.hpp"

namespace palpate::force_estimation {

/// Settings of force estimation from the robot's shape.
struct ShapeConfig {
  std::string matching = "patch";
  double hidden_distance_m = 0.0;
  double outlier_distance_m = 0.0;
  int matching_rounds = 3;
  int untouched_frames = 30;
  double pose_prior_m = 2e-3;
  double pose_prior_rad = 5e-3;
  double depth_bias_prior = 5e-3;
  int depth_bias_order = 2;
  double feature_offset_prior_m = 3e-4;
  double model_relative_sigma = 0.03;
  double robust_threshold = 3.0;
  double contact_radius_m = 0.006;
  double largest_friction = 1.0;
  double force_relative_sigma = 0.015;
  double force_rate_N_s = 2.0;
  double fit_tolerance = 3e-3;
  double frame_work = 24.0;
  double significance = 1e-5;
  double hidden_significance = 1e-6;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("matching", matching, {"patch", "point"},
      "Algorithm 3: point takes the cloud point nearest to a surface point's normal line, as "
      "published; patch averages all points on the surface point's share of the surface");
    v("hidden_distance_m", hidden_distance_m, {.min = 0.0},
      "d_m: a surface point without a cloud point within this distance of its normal line is "
      "hidden; 0: from the cloud's spacing");
    v("outlier_distance_m", outlier_distance_m, {.min = 0.0},
      "d_l: a match farther away is an outlier; 0: 15 mm and three standard deviations of the "
      "depth");
    v("matching_rounds", matching_rounds, {.min = 1.0, .max = 20.0},
      "Rounds of matching and fitting per frame");
    v("untouched_frames", untouched_frames, {.min = 0.0, .max = 10000.0},
      "Contact-free frames at the start, from which the depth bias is estimated; none where the "
      "calibration gives it. 0: it is estimated together with the forces of each frame, with wider "
      "intervals");
    v("pose_prior_m", pose_prior_m, {.min = 0.0, .min_open = true},
      "Prior standard deviation of the camera position");
    v("pose_prior_rad", pose_prior_rad, {.min = 0.0, .min_open = true},
      "Prior standard deviation of the camera orientation");
    v("depth_bias_prior", depth_bias_prior, {.min = 0.0, .min_open = true},
      "Prior standard deviation of the depth bias, as a share of z");
    v("depth_bias_order", depth_bias_order, {.min = 0.0, .max = 4.0},
      "Polynomial order of the depth bias over the image");
    v("feature_offset_prior_m", feature_offset_prior_m, {.min = 0.0, .min_open = true},
      "Prior standard deviation of the constant offset of each surface point");
    v("model_relative_sigma", model_relative_sigma, {.min = 0.0, .max = 1.0},
      "Standard deviation of the model error, as a share of the displacement");
    v("robust_threshold", robust_threshold, {.min = 1.0},
      "Huber threshold, in standard deviations");
    v("contact_radius_m", contact_radius_m, {.min = 0.0},
      "Smallest radius of the patch over which a contact force is spread");
    v("largest_friction", largest_friction, {.min = 0.0},
      "Largest ratio of tangential to normal force of a contact");
    v("force_relative_sigma", force_relative_sigma, {.min = 0.0, .max = 1.0},
      "Standard deviation of the error common to all forces, such as that of the modulus, as a "
      "share of them");
    v("force_rate_N_s", force_rate_N_s, {.min = 0.0},
      "Standard deviation of the change of a force in one second, for smoothing over frames; 0: "
      "no smoothing");
    v("fit_tolerance", fit_tolerance, {.min = 1e-11, .max = 0.1},
      "frame_tolerance of the fits of one frame");
    v("frame_work", frame_work, {.min = 0.0},
      "Work per frame, in substitutions (about 2 ms each; a factorisation counts 8); what can "
      "wait is left to later frames, and a fit ends with budget_reached after four times as "
      "much; 0: no limit");
    v("significance", significance, {.min = 0.0, .max = 0.5, .min_open = true},
      "False-alarm probability per frame of a force at a visible contact");
    v("hidden_significance", hidden_significance, {.min = 0.0, .max = 0.5, .min_open = true},
      "False-alarm probability per frame, hidden contacts");
  }
};

}  // namespace palpate::force_estimation
