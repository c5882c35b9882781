// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "libs/core/config_reader.hpp"

namespace palpate::force_estimation {

/// Settings of MarkerForceEstimator.
struct Config {
  /// Where contacts may be: each "name: x, y, z[, patch radius][ along dx, dy, dz]" (m, undeformed
  /// body, robot frame; the direction where it is known, as of a hung weight). Empty: the robot's
  /// feature points are searched.
  std::vector<std::string> contacts;
  double candidate_patch_radius_m = 0.005;
  int max_contacts = 1;
  double marker_sigma_m = 1e-4;
  double marker_bias_m = 0.0;
  double contact_marker_weight = 0.01;
  double significance = 1e-3;
  double unobservable_sigma_N = 1.0;
  int max_iterations = 40;
  double force_tolerance_N = 1e-11;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("contacts", contacts,
      "Contacts as \"name: x, y, z[, patch radius][ along dx, dy, dz]\", m, undeformed body; "
      "empty: "
      "search");
    v("candidate_patch_radius_m", candidate_patch_radius_m, {.min = 0.0},
      "Patch over which a contact found by search is spread");
    v("max_contacts", max_contacts, {.min = 1.0, .max = 5.0},
      "Contacts that the search may find at once");
    v("marker_sigma_m", marker_sigma_m, {.min = 0.0, .min_open = true},
      "Marker noise where the data do not say theirs");
    v("marker_bias_m", marker_bias_m, {.min = 0.0},
      "Constant error of each marker that averaging does not remove, one sigma");
    v("contact_marker_weight", contact_marker_weight, {.min = 0.0, .max = 1.0},
      "Weight of a marker that stands on a given contact's patch, where the pressure's unknown "
      "distribution dents the surface");
    v("significance", significance, {.min = 0.0, .max = 0.5, .min_open = true},
      "Chance of a false contact from noise alone in one frame");
    v("unobservable_sigma_N", unobservable_sigma_N, {.min = 0.0, .min_open = true},
      "A force component known no better than this is called unobservable");
    v("max_iterations", max_iterations, {.min = 1.0, .max = 1000.0}, "Linearisations in one frame");
    v("force_tolerance_N", force_tolerance_N, {.min = 0.0, .min_open = true},
      "Change of the forces at which the iteration stops");
  }
};

}  // namespace palpate::force_estimation
