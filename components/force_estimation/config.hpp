// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "libs/core/config_reader.hpp"
#include "libs/fem/sparse/solver_settings.hpp"

namespace palpate::force_estimation {

/// Settings of MarkerForceEstimator and of the model it works with.
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
  double frame_tolerance = 1e-10;
  double frame_budget_s = 0.0;
  std::string solver = fem::SolverSettings().solver;
  int threads = fem::SolverSettings().threads;

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
    v("frame_tolerance", frame_tolerance, {.min = 1e-11, .max = 0.1},
      "A frame has converged when residual / forces, cable length missed / cable length and the "
      "forces' next change / largest force (1 N at least) are no larger");
    v("frame_budget_s", frame_budget_s, {.min = 0.0},
      "Time for one frame with given contacts, once the first was found; 0: no limit");
    v("solver", solver, fem::SolverNames(), "Sparse Cholesky of the model");
    v("threads", threads, {.min = 1.0, .max = 64.0},
      "Threads that assemble, factorise and solve; the results do not depend on it");
  }
};

}  // namespace palpate::force_estimation
