// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "components/force_estimation/shape/contact_location_posterior.hpp"
#include "components/force_estimation/shape/observation_jacobian.hpp"
#include "components/force_estimation/shape/shape_config.hpp"
#include "libs/correspondence/surface_features.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// What the search looks at: rows about the state of the model, and what the forces that are known
/// already leave over.
struct Unexplained {
  Eigen::VectorXd residual_m;  ///< [m] target - model
  Eigen::VectorXd weight;      ///< [m] 1 / variance
  /// [m x q] what the rows do when a known contact's force changes, m/N: these are fitted along.
  Eigen::MatrixXd known;
  /// [m] The part of residual_m that the state leaves, where contacts of the state were taken out
  /// to first order (their response times force added), to be found anew; empty: all of it. The
  /// first order errs by a part of this.
  Eigen::VectorXd left_m = {};
  /// [m x q] Errors that the rows may have together, each to a standard normal factor.
  Eigen::MatrixXd errors_m = {};
  const ObservationJacobian* responses = nullptr;  ///< about the shape that was last looked at
  std::vector<int> row = {};                       ///< [m] which of the rows of `responses` each is
};

/// Where the residual says that something pushes.
struct HiddenContact {
  Eigen::Vector3d rest_position_m = Eigen::Vector3d::Zero();  ///< undeformed body, robot frame
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< outward, unit, in the present shape
  double force_N = 0.0;  ///< along the inward normal, to first order, > 0
  Eigen::Vector3d tangential_N = Eigen::Vector3d::Zero();  ///< most likely friction, robot frame
  /// By which the weighted residual falls when this contact joins the known ones and, of two, the
  /// other, all of which are refitted.
  double chi_squared_gain = 0.0;
  Eigen::Matrix3d location_covariance_m2 = Eigen::Matrix3d::Zero();
  double location_ci95_m = 0.0;  ///< radius that holds the place with 95 %
  /// Of the force, because the place is not known.
  Eigen::Matrix3d force_covariance_N2 = Eigen::Matrix3d::Zero();
};

/// Finds contacts that nobody saw from the deformation alone, by the responses to forces on patches
/// all over the surface. A contact pushes along the inward normal of the present shape (LookAt,
/// before all else), with friction beside it; none pulls.
///
/// Whether there is one: the best of all candidates against the chance that noise does as well
/// (false_alarm.hpp). Where it is: the posterior over all places
/// (contact_location_posterior.hpp), with known forces refitted along. All to first order about the
/// state.
class HiddenSearch {
 public:
  /// `model` must outlive the search. Of `config` contact_radius_m counts (1 mm at least). Throws
  /// InputError where no part of the surface is free.
  HiddenSearch(const robot::RobotModel& model, const ShapeConfig& config);
  ~HiddenSearch();

  int CandidateCount() const;

  /// The present shape: nodes [3n].
  void LookAt(const Eigen::VectorXd& x_m);

  /// At most `most` (1 or 2) contacts that explain `data` beyond the noise with a false-alarm
  /// chance below `significance` for one call; empty: none. Sites already taken (rest positions)
  /// and their neighbourhood of `taken_radius_m` are left out. A large push bends the body beyond
  /// the first order: solve for the equilibrium with what was found, look at it, and find
  /// anew with `left_m`, as long as what is left falls. Of two contacts that one explains to within
  /// the error of the first order, only then two come out.
  const std::vector<HiddenContact>& Find(const Unexplained& data, int most, double significance,
                                         const std::vector<Eigen::Vector3d>& taken,
                                         double taken_radius_m);

  /// Where contacts that were found before are now: as many as there are in `before`, in the same
  /// order, each refitted along with the others. Empty: where one of them does not push any more.
  const std::vector<HiddenContact>& Follow(const Unexplained& data,
                                           const std::vector<PlacePrior>& before,
                                           const std::vector<Eigen::Vector3d>& taken,
                                           double taken_radius_m);

  /// Sigma of the normal force of a contact at this place of the undeformed body, fitted along with
  /// the known ones to rows of these weights (the residual does not matter), N.
  double SigmaOfForce_N(const Unexplained& data, const Eigen::Vector3d& rest_position_m) const;
  /// How many of these sigmas a force must reach so that Find takes it for more than noise: more
  /// than one test of that significance asks for, as there are many candidates.
  double Threshold_sigmas(const Unexplained& data, double significance) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::force_estimation
