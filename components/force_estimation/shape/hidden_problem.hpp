// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/force_estimation/shape/candidate_locations.hpp"
#include "components/force_estimation/shape/observation_jacobian.hpp"

namespace palpate::force_estimation {

/// The fit of a contact at one place to the residual.
struct PlaceFit {
  double force_N = 0.0;  ///< along the inward normal; 0: a push does not improve the fit
  Eigen::Vector3d tangential_N = Eigen::Vector3d::Zero();  ///< most likely friction
  double gain = 0.0;                                       ///< decrease of chi^2
  double evidence = 0.0;  ///< twice the log of the likelihood over that without the contact
};

/// Normal equations of a force at one place.
struct PlaceEquations {
  Eigen::Matrix3d gram =
      Eigen::Matrix3d::Zero();  ///< C' C, C: response to unit forces along x, y, z
  Eigen::Vector3d pull = Eigen::Vector3d::Zero();  ///< C' residual
};

struct FitPushTuning {
  /// Iterations: the push sets the sigma of the friction, which sets the push. More: slower, and a
  /// push that fits its own friction better.
  int friction_rounds = 2;
};

/// Fits a push along the inward normal with friction: tangential components of normal distribution
/// about 0 with a sigma of `friction` times the push.
PlaceFit FitPush(const PlaceEquations& equations, const Eigen::Vector3d& normal, double friction,
                 const FitPushTuning& tuning = {});

/// The residual in units of its noise, and its response to unit forces on the candidates. Other
/// causes (forces that are refitted, each with its prior) are absorbed into the noise, which leaves
/// a least-squares problem with unit weights.
class HiddenProblem {
 public:
  /// `residual_m` [m] of the rows `row` of `responses`, and 1 / sigma of each. Places and responses
  /// must outlive the problem and its copies.
  HiddenProblem(const CandidateLocations& places, const ObservationJacobian& responses,
                std::vector<int> row, const Eigen::VectorXd& scale_1_m,
                const Eigen::VectorXd& residual_m);

  const Eigen::VectorXd& residual() const { return residual_; }

  /// Causes of unknown size, one column [m] for each, in the units that Place returns now. With a
  /// standard normal prior of their factors:
  void Absorb(const Eigen::MatrixXd& columns);
  /// and without a prior: the residual along them has no weight. Columns may be zero.
  void Ignore(Eigen::MatrixXd columns);

  /// Response to unit forces at a place along x, y, z [m x 3].
  Eigen::MatrixX3d Place(int place) const;
  /// Motions of all rows of the responses [r x k], m, in the units of this problem [m x k].
  Eigen::MatrixXd Whitened(const Eigen::MatrixXd& motion_m) const;

  /// For FitPush at each of these places. Many together cost little more than the responses.
  std::vector<PlaceEquations> EquationsAt(const std::vector<int>& places) const;
  PlaceEquations EquationsAt(int place) const { return EquationsAt(std::vector{place}).front(); }

 private:
  const CandidateLocations* places_;
  const ObservationJacobian* responses_;
  std::vector<int> row_;
  Eigen::MatrixXd whitening_;  ///< [m x m] from metres
  Eigen::VectorXd residual_;
};

}  // namespace palpate::force_estimation
