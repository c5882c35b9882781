// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "libs/core/config_reader.hpp"
#include "libs/fem/sparse/solver_settings.hpp"

namespace palpate::force_estimation {

/// Settings of MarkerForceEstimator and of its model.
struct Config {
  /// Given contacts, each "name: x, y, z[, patch radius][ along dx, dy, dz]" (m, undeformed body,
  /// robot frame; with a direction where it is known, as of a hung weight). Empty: contacts are
  /// searched among the robot's feature points.
  std::vector<std::string> contacts;
  double candidate_patch_radius_m = 0.005;
  int max_contacts = 1;
  double marker_sigma_m = 1e-4;
  double marker_bias_m = 0.0;
  double contact_marker_weight = 0.01;
  double significance = 1e-3;
  double unobservable_sigma_N = 1.0;
  double uncertain_share = 0.5;
  bool adhesion = false;
  double friction_sigma = 1.0;
  int max_iterations = 40;
  double frame_tolerance = 1e-10;
  double frame_budget_s = 0.0;
  std::string solver = fem::SolverSettings().solver;
  int threads = fem::SolverSettings().threads;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("contacts", contacts,
      "Contacts as \"name: x, y, z[, patch radius][ along dx, dy, dz]\", m, undeformed body; "
      "empty: search");
    v("candidate_patch_radius_m", candidate_patch_radius_m, {.min = 0.0},
      "Radius of the patch of a contact found by search");
    v("max_contacts", max_contacts, {.min = 1.0, .max = 5.0},
      "Largest number of contacts that the search may find at once");
    v("marker_sigma_m", marker_sigma_m, {.min = 0.0, .min_open = true},
      "Standard deviation of the marker noise where the data do not give it");
    v("marker_bias_m", marker_bias_m, {.min = 0.0},
      "Standard deviation of the constant error of each marker, which averaging does not remove");
    v("contact_marker_weight", contact_marker_weight, {.min = 0.0, .max = 1.0},
      "Weight of a marker on a given contact's patch, where the unknown pressure distribution "
      "dents the surface");
    v("significance", significance, {.min = 0.0, .max = 0.5, .min_open = true},
      "False-alarm probability per frame");
    v("unobservable_sigma_N", unobservable_sigma_N, {.min = 0.0, .min_open = true},
      "Standard deviation above which a force component is unobservable");
    v("uncertain_share", uncertain_share, {.min = 0.0, .min_open = true},
      "Half-width of the 95 % interval, as a share of |F|, above which a force is uncertain; the "
      "default is that of a force just detected at the default significance");
    v("adhesion", adhesion,
      "Whether a contact found by search may pull; false: contacts push on the outer surface");
    v("friction_sigma", friction_sigma, {.min = 0.0, .min_open = true},
      "Standard deviation of the ratio of tangential to normal force of a contact found by search, "
      "and of one whose tangential force the markers do not determine");
    v("max_iterations", max_iterations, {.min = 1.0, .max = 1000.0},
      "Largest number of linearisations per frame");
    v("frame_tolerance", frame_tolerance, {.min = 1e-11, .max = 0.1},
      "Convergence: largest of residual / forces, missed cable length / cable length, and next "
      "change / largest force (1 N at least)");
    v("frame_budget_s", frame_budget_s, {.min = 0.0},
      "Time limit of one frame with given contacts, after the first fit; 0: no limit");
    v("solver", solver, fem::SolverNames(), "Sparse Cholesky of the model");
    v("threads", threads, {.min = 1.0, .max = 64.0},
      "Threads of assembly, factorisation and solve; results agree to rounding");
  }
};

}  // namespace palpate::force_estimation
