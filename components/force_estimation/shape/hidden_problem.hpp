// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/force_estimation/shape/candidate_locations.hpp"
#include "components/force_estimation/shape/observation_jacobian.hpp"

namespace palpate::force_estimation {

/// What a contact at one place says about the residual.
struct PlaceFit {
  double force_N = 0.0;  ///< along the inward normal; 0: only a pull would help
  Eigen::Vector3d tangential_N = Eigen::Vector3d::Zero();  ///< most likely friction
  double gain = 0.0;                                       ///< by which chi^2 falls
  double evidence = 0.0;  ///< twice the log of the likelihood over that without the contact
};

/// All that the fit of a push at one place goes by.
struct PlaceEquations {
  Eigen::Matrix3d gram = Eigen::Matrix3d::Zero();  ///< C' C, C: what unit forces along x, y, z do
  Eigen::Vector3d pull = Eigen::Vector3d::Zero();  ///< C' residual
};

/// Fits a push along the inward normal with friction beside it: tangential components of normal
/// distribution about 0 with a sigma of `friction` times the push.
PlaceFit FitPush(const PlaceEquations& equations, const Eigen::Vector3d& normal, double friction);

/// The residual in units of its noise and what unit forces on the candidates do to it. Whatever
/// else may have caused it (forces refitted along, each with its prior) is absorbed into the noise,
/// so that all that follows is least squares with unit weights.
class HiddenProblem {
 public:
  /// `residual_m` [m] of the rows `row` of `responses`, and 1 / sigma of each. Places and responses
  /// must outlive the problem and its copies.
  HiddenProblem(const CandidateLocations& places, const ObservationJacobian& responses,
                std::vector<int> row, const Eigen::VectorXd& scale_1_m,
                const Eigen::VectorXd& residual_m);

  const Eigen::VectorXd& residual() const { return residual_; }

  /// Causes known up to their size, one column [m] for each, in the units that Place gives now.
  /// Known to a standard normal factor:
  void Absorb(const Eigen::MatrixXd& columns);
  /// and not known at all: the residual along them counts for nothing. Zero columns are fine.
  void Ignore(Eigen::MatrixXd columns);

  /// What a unit force does: at a place along x, y, z [m x 3],
  Eigen::MatrixX3d Place(int place) const;
  /// and, of what it does to all rows of the responses [r x k], m, what this problem sees [m x k].
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
