// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/core/config_reader.hpp"

namespace palpate::perception {

/// Algorithm 2 of the paper.
struct ContactConfig {
  double r_search_m = 0.0;
  double hidden_depth_m = 0.010;
  int n_neigh = 0;
  double cluster_distance_m = 0.0;
  int min_points = 4;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("r_search_m", r_search_m, {.min = 0.0, .max = 0.1},
      "An object's point has its neighbours among the robot's within this radius; 0: from "
      "hidden_depth_m, the spacing and the noise of the clouds");
    v("hidden_depth_m", hidden_depth_m, {.min = 0.0, .max = 0.1},
      "Where r_search_m is 0: an object that hides its own contact from the camera is seen so far "
      "from it at least");
    v("n_neigh", n_neigh, {.min = 0.0, .max = 1000.0},
      "A point with more neighbours than this touches; 0: a tenth of what half a disc of the "
      "search radius holds at the robot cloud's spacing");
    v("cluster_distance_m", cluster_distance_m, {.min = 0.0, .max = 0.1},
      "Touching points no farther apart belong to one contact; 0: from the spacing and the "
      "noise of the clouds");
    v("min_points", min_points, {.min = 1.0, .max = 1000.0}, "Smaller groups are no contact");
  }
};

/// How contacts keep their names over the frames.
struct TrackingConfig {
  double gate_m = 0.02;
  int appear_frames = 3;
  int vanish_frames = 3;
  double smoothing = 0.5;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("gate_m", gate_m, {.min = 0.0, .max = 1.0, .min_open = true},
      "A contact moves no farther than this from one frame to the next");
    v("appear_frames", appear_frames, {.min = 1.0, .max = 1000.0},
      "A contact is there once it was seen in so many frames in a row, or in the first frame of a "
      "camera that was opened");
    v("vanish_frames", vanish_frames, {.min = 1.0, .max = 1000.0},
      "It is gone once it was missing in so many frames in a row");
    v("smoothing", smoothing, {.min = 0.0, .max = 0.95},
      "Share of its last place in the new one; 0: none");
  }
};

}  // namespace palpate::perception
