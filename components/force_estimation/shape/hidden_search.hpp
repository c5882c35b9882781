// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "components/force_estimation/shape/body_scale.hpp"
#include "components/force_estimation/shape/candidate_locations.hpp"
#include "components/force_estimation/shape/contact_location_posterior.hpp"
#include "components/force_estimation/shape/false_alarm.hpp"
#include "components/force_estimation/shape/observation_jacobian.hpp"
#include "components/force_estimation/shape/shape_config.hpp"
#include "libs/correspondence/surface_features.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// Input of the search: rows about the state of the model, and their residual with the known
/// forces.
struct Unexplained {
  Eigen::VectorXd residual_m;  ///< [m] target - model
  Eigen::VectorXd weight;      ///< [m] 1 / variance
  /// [m x q] derivative of the rows to the known contacts' forces, m/N: these are refitted.
  Eigen::MatrixXd known;
  /// [m] The residual of the state itself, where contacts of the state were removed to first order
  /// (their response times force added) to be located again; empty: residual_m. The linearisation
  /// error is a share of this.
  Eigen::VectorXd left_m = {};
  /// [m x q] Errors common to the rows, each with a standard normal factor.
  Eigen::MatrixXd errors_m = {};
  const ObservationJacobian* responses = nullptr;  ///< about the shape of SetShape
  std::vector<int> row = {};                       ///< [m] which of the rows of `responses` each is
};

/// A contact that explains the residual.
struct HiddenContact {
  Eigen::Vector3d rest_position_m = Eigen::Vector3d::Zero();  ///< undeformed body, robot frame
  /// To the mean of the places where it may be, which differ in force: the prior of later searches.
  Eigen::Vector3d mean_off_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< outward, unit, in the present shape
  double force_N = 0.0;  ///< along the inward normal, to first order, > 0
  Eigen::Vector3d tangential_N = Eigen::Vector3d::Zero();  ///< most probable friction, robot frame
  /// Decrease of chi-squared when this contact is added to the known ones and, of two, the other,
  /// all of which are refitted.
  double chi_squared_gain = 0.0;
  Eigen::Matrix3d location_covariance_m2 = Eigen::Matrix3d::Zero();
  double location_ci95_m = 0.0;  ///< radius that contains the location with 95 %
  /// Of the force, by the uncertainty of the location.
  Eigen::Matrix3d force_covariance_N2 = Eigen::Matrix3d::Zero();
};

struct HiddenSearchTuning {
  CandidateLocationsTuning places = {};
  FalseAlarmTuning false_alarm = {};
  ContactLocationTuning location = {};
  /// Lower bound of the patch radius: the response to a force on a point depends on the mesh.
  /// Larger: a blunter, smoother response.
  double least_patch_radius_m = 1e-3;
  /// Sigma of the tangential over the normal force. Larger: friction explains what may be another
  /// location, so that locations are less certain.
  double friction = 0.3;
  /// Linearisation error as a share of the displacement to be explained, one sigma: of this row and
  /// of all rows, half and half. Forces of 0.3 to 1.5 N bend our robot by up to 20 mm. Larger:
  /// wider posteriors, two contacts found as one; smaller: false second contacts.
  double first_order_error = 0.15;
  /// Location error of the other of two contacts while one is located, in places, one sigma, over
  /// this many neighbours. Larger: a less certain location.
  double off_places = 2.0;
  int neighbours = 6;
  int pair_rounds = 3;  ///< alternations between two contacts; more: slower, closer to the optimum
  int follow_rounds = 2;  ///< the same for contacts that are tracked
  /// Response below which a candidate is not observable, as a share of the largest. Larger: fewer
  /// candidates, that have smaller forces.
  double unobserved_response = 1e-6;
};

/// Finds hidden contacts from the deformation alone, by the responses to forces on patches all over
/// the surface. A contact pushes along the inward normal of the present shape (SetShape), with
/// friction; none pulls.
///
/// Detection: the best of all candidates against the false-alarm probability of noise
/// (false_alarm.hpp). Location: the posterior over all places (contact_location_posterior.hpp),
/// with known forces refitted. Both to first order about the state.
class HiddenSearch {
 public:
  /// `model`, of this scale, must outlive the search. Of `config` contact_radius_m is used. Throws
  /// InputError where no part of the surface is free.
  HiddenSearch(const robot::RobotModel& model, const ShapeConfig& config, const BodyScale& scale,
               const HiddenSearchTuning& tuning = {});
  ~HiddenSearch();

  int CandidateCount() const;

  /// The present shape: nodes [3n]. Before the first search.
  void SetShape(const Eigen::VectorXd& x_m);

  /// At most `most` (1 or 2) contacts that explain `data` beyond the noise with a false-alarm
  /// probability below `significance` for one call; empty: none. Sites already taken (rest
  /// positions) and their neighbourhood of `taken_radius_m` are left out. A large push bends the
  /// body beyond the first order: solve for the equilibrium with the contacts found, SetShape, and
  /// search again with `left_m`, as long as the residual falls. Two contacts that one explains to
  /// within the linearisation error are separated only then.
  const std::vector<HiddenContact>& Find(const Unexplained& data, int most, double significance,
                                         const std::vector<Eigen::Vector3d>& taken,
                                         double taken_radius_m);

  /// Present locations of contacts that were found before, in the order of `before`, all refitted.
  /// Empty: one of them pushes no more.
  const std::vector<HiddenContact>& Follow(const Unexplained& data,
                                           const std::vector<PlacePrior>& before,
                                           const std::vector<Eigen::Vector3d>& taken,
                                           double taken_radius_m);

  /// Sigma of the normal force of a contact at this place of the undeformed body, fitted together
  /// with the known ones to rows of these weights, N; independent of the residual.
  double SigmaOfForce_N(const Unexplained& data, const Eigen::Vector3d& rest_position_m) const;
  /// Force in these sigmas from which Find reports it: above the quantile of a single test, as
  /// there are many candidates.
  double Threshold_sigmas(const Unexplained& data, double significance) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::force_estimation
