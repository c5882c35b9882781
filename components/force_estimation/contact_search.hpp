// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/force_estimation/contact_site.hpp"
#include "components/force_estimation/fit/force_fitter.hpp"
#include "libs/fem/static_solver.hpp"

namespace palpate::force_estimation {

/// Searches contact locations from the deformation alone, among the robot's feature points. All
/// candidates are screened to first order, the best are fitted to equilibrium, and contacts are
/// added one by one while the residual is beyond the noise (Config::significance). Contacts that
/// still explain the markers of the next frame keep their location and name.
class ContactSearch {
 public:
  struct Result {
    Status status;  ///< kNoContact: the model without contact explains the markers
    ForceFit fit;
    ModelState state;
    std::vector<ContactSite> sites;
    std::vector<FitSite> fit_sites;
    /// Radius of the 95 % confidence region of the location, m; at least half the distance between
    /// candidates.
    double location_ci95_m = 0.0;
  };

  /// `model` and `fitter` must outlive the search. Throws InputError where the robot has no feature
  /// points.
  ContactSearch(robot::RobotModel& model, const Config& config, ForceFitter& fitter);

  /// `free_state`: the equilibrium without contact under these cable inputs.
  const Result& Find(const RowTargets& targets, const std::vector<robot::CableCommand>& cables,
                     const fem::StaticState& free_state);

  const Result& result() const { return result_; }

 private:
  bool KeepContacts(const RowTargets& targets, const std::vector<robot::CableCommand>& cables,
                    double noise_limit);
  Status AddContact(const RowTargets& targets, const std::vector<robot::CableCommand>& cables);
  double LocationInterval(const std::vector<double>& chi_squared, size_t best,
                          double noise_scale) const;

  Config config_;
  ForceFitter& fitter_;
  std::vector<FitSite> candidates_;
  double spacing_m_ = 0.0;             ///< mean distance from a candidate to the next
  std::vector<size_t> chosen_;         ///< candidates at which there is a contact
  double searched_chi_squared_ = 0.0;  ///< of the last search
  double searched_force_N_ = 0.0;      ///< norm of all forces of that search
  Result result_;
};

}  // namespace palpate::force_estimation
