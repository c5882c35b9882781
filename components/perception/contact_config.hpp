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
      "Radius of neighbour search from object points to robot points (Algorithm 2); 0: from "
      "hidden_depth_m, the spacing and the noise of the clouds");
    v("hidden_depth_m", hidden_depth_m, {.min = 0.0, .max = 0.1},
      "Where r_search_m is 0: assumed distance of the visible part of an object from the contact "
      "that it hides");
    v("n_neigh", n_neigh, {.min = 0.0, .max = 1000.0},
      "Number of neighbours above which a point is in contact (Algorithm 2); 0: a tenth of what "
      "half a disc of the search radius holds at the robot cloud's spacing");
    v("cluster_distance_m", cluster_distance_m, {.min = 0.0, .max = 0.1},
      "Largest distance of neighbouring points of one contact; 0: from the spacing and the noise "
      "of the clouds");
    v("min_points", min_points, {.min = 1.0, .max = 1000.0},
      "Smallest number of points of a contact");
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
      "Largest motion of a contact from one frame to the next");
    v("appear_frames", appear_frames, {.min = 1.0, .max = 1000.0},
      "Consecutive frames after which a contact is reported; one in the first frame of an opened "
      "camera is reported at once");
    v("vanish_frames", vanish_frames, {.min = 1.0, .max = 1000.0},
      "Consecutive frames without a contact after which it is dropped");
    v("smoothing", smoothing, {.min = 0.0, .max = 0.95},
      "Weight of the last location in the new one (exponential smoothing); 0: none");
  }
};

}  // namespace palpate::perception
