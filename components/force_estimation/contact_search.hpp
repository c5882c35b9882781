// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "components/force_estimation/contact_candidates.hpp"
#include "components/force_estimation/contact_site.hpp"
#include "components/force_estimation/fit/force_newton.hpp"
#include "components/force_estimation/target_pool.hpp"
#include "libs/fem/static_solver.hpp"

namespace palpate::force_estimation {

/// Searches contact locations from the deformation alone, on the surface that something can touch
/// (ContactCandidates). All candidates are screened to first order, the best are fitted to
/// equilibrium, both again about the best state until it stays, and contacts are added one by one
/// while the residual is beyond the noise (Config::significance). A contact pushes, unless
/// Config::adhesion.
///
/// Contacts that still explain the markers of the next frame keep their name. While they and the
/// cables stay as they are, frames are averaged, and after 4, 8, 16, ... frames the location is
/// searched again in their mean.
class ContactSearch {
 public:
  struct Result {
    Status status;  ///< kNoContact: the model without contact explains the markers
    ForceFit fit;
    ModelState state;
    std::vector<ContactSite> sites;
    std::vector<FitSite> fit_sites;
    /// [sites] covariance of each force from the uncertainty of its location.
    std::vector<Eigen::Matrix3d> location_covariance_N2;
    /// [sites] of the place on the deformed surface, robot frame.
    std::vector<Eigen::Matrix3d> location_covariance_m2;
    /// Radius of the 95 % confidence region of the location, m; at least half the distance between
    /// candidates.
    double location_ci95_m = 0.0;
  };

  /// `model` and `fitter` must outlive the search. Throws InputError where the robot has no feature
  /// points.
  ContactSearch(robot::RobotModel& model, const Config& config, ForceNewton& fitter);

  /// `shared_variance_m2` [rows]: the part of the variance that is of an error which all frames
  /// share. `free_state`: the equilibrium without contact under these cable inputs.
  const Result& Find(const RowTargets& targets, const Eigen::VectorXd& shared_variance_m2,
                     const std::vector<robot::ActuatorCommand>& cables,
                     const fem::StaticState& free_state);

  const Result& result() const { return found_.result; }

 private:
  /// A candidate and the force there, to first order. `score`: chi-squared and the prior's cost.
  struct Screened {
    FitSite site;
    Eigen::Vector3d force_N;
    double score = 0.0;
  };
  /// One more contact, fitted to equilibrium. `score` as of Screened.
  struct Fitted {
    FitSite site;
    ForceFit fit;
    ModelState state;
    double score = std::numeric_limits<double>::infinity();
  };
  /// The force with which the fit of a candidate begins.
  enum class FirstForce { kScreened, kNone };
  /// What the last search found, and the frame after it fitted again.
  struct Found {
    Result result;
    std::vector<Eigen::Matrix3d> location_covariance_N2;  ///< of the search
    double chi_squared = 0.0;                             ///< of the search
    double force_N = 0.0;                                 ///< norm of all forces of the search
  };

  void Search(const RowTargets& targets, const std::vector<robot::ActuatorCommand>& cables,
              const ModelState& start, const ModelState* about, double limit);
  void SearchInMean(const RowTargets& targets, const std::vector<robot::ActuatorCommand>& cables,
                    const ModelState& start, double limit);
  bool KeepContacts(const RowTargets& targets, const std::vector<robot::ActuatorCommand>& cables,
                    double noise_limit);
  Status AddContact(const RowTargets& targets, const std::vector<robot::ActuatorCommand>& cables,
                    const ModelState* known_state);
  Status ScreenSites(const RowTargets& targets, const std::vector<robot::ActuatorCommand>& cables,
                     const ModelState& state, const std::vector<FitSite>& sites,
                     std::vector<Screened>* screened);
  Status ScreenAll(const RowTargets& targets, const std::vector<robot::ActuatorCommand>& cables,
                   const ModelState& state, std::vector<Screened>* screened);
  bool FitCandidate(const RowTargets& targets, const std::vector<robot::ActuatorCommand>& cables,
                    const ModelState& start, const Screened& candidate, FirstForce first_force,
                    Fitted* fitted);
  static bool IsBetter(const Fitted& a, const Fitted& b);
  bool FitBest(const RowTargets& targets, const std::vector<robot::ActuatorCommand>& cables,
               const ModelState& start, const std::vector<Screened>& screened,
               FirstForce first_force, std::vector<Eigen::Vector3d>* fitted_m, Fitted* best);
  bool IsTaken(const FitSite& site) const;
  void AddUncertainty(const std::vector<Screened>& screened, const Fitted& best,
                      double noise_scale);

  Config config_;
  ForceNewton& fitter_;
  ContactCandidates candidates_;
  TargetPool pool_;
  Found found_;
};

}  // namespace palpate::force_estimation
