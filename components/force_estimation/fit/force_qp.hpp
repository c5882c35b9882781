// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/force_estimation/fit/actuator_condensation.hpp"
#include "components/force_estimation/fit/observable_subspace.hpp"
#include "libs/core/status.hpp"
#include "libs/fem/bounded_qp.hpp"
#include "libs/robot/compliance.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// Measured values of the observed rows: coordinates of markers, or of surface points along their
/// normals.
struct RowTargets {
  Eigen::VectorXd value_m;  ///< [rows]
  Eigen::VectorXd weight;   ///< [rows] 1 / variance, 1/m^2; 0: not measured
  int rows = 0;             ///< with a weight above 0
};

/// The paper's QP, eqs. (11) and (12), at one linearisation of the robot: contact forces at given
/// sites that fit the observed rows by least squares, with a Gaussian prior, under the inputs of
/// the actuators (eqs. (13) and (14)). Which cables are taut is found with the forces. The forces
/// are fitted in the observable subspace; at first, that is every direction.
class ForceQp {
 public:
  /// `rows`: of the observation, at first.
  ForceQp(int rows, const std::vector<robot::ActuatorTraits>& traits);

  /// Removes the prior. Errors: more than fem::kMaxQpVariables components.
  void SetSites(const std::vector<FitSite>& sites);
  const std::vector<FitSite>& sites() const { return sites_; }  ///< [k]

  /// Gaussian prior of lambda_f: mean zero, inverse covariance [3k x 3k], 1/N^2.
  void SetPrior(const fem::QpMatrix& information) { prior_information_ = information; }
  const fem::QpMatrix& prior() const { return prior_information_; }

  /// Fits every direction of every site, or the given one.
  void IncludeAllDirections() { observable_.IncludeAll(sites_); }
  /// Fits no longer what the rows determine worse than to `largest_sigma_N`.
  void KeepObservable(const RowTargets& targets, double largest_sigma_N);
  const ObservableSubspace& observable() const { return observable_; }

  /// Begins with the cables taut that have a tension in `lambda_a_N` [a].
  void Start(const std::vector<robot::ActuatorCommand>& commands,
             const Eigen::VectorXd& lambda_a_N) {
    condensation_.Start(commands, lambda_a_N);
  }
  /// Sets lambda_f_N() and lambda_a_N(); begins at `start_lambda_f_N` [3k]. `damping`: weight of
  /// the change from there, as a share of the largest information (Levenberg and Marquardt); it
  /// shortens first what the rows determine least. Not ok where the actuators' responses are
  /// linearly dependent, or the forces without a minimum.
  Status Solve(const robot::Compliance& compliance, const RowTargets& targets,
               const std::vector<robot::ActuatorCommand>& commands,
               const Eigen::VectorXd& start_lambda_f_N, double damping = 0.0);
  const Eigen::VectorXd& lambda_f_N() const { return lambda_f_N_; }  ///< [3k] robot frame
  const Eigen::VectorXd& lambda_a_N() const { return lambda_a_N_; }  ///< [a]

  /// Response of the rows to lambda_f under the actuators' inputs.
  const ActuatorCondensation& response() const { return condensation_; }
  /// Weighted residual of the rows under lambda_f_N(), to first order.
  double ChiSquared(const RowTargets& targets) const;
  /// G' W G and the prior [3k x 3k], 1/N^2; W: the weights.
  fem::QpMatrix Information(const RowTargets& targets) const;
  /// Of lambda_f [3k x 3k]; zero along directions that are not fitted, or have no information.
  fem::QpMatrix Covariance_N2(const RowTargets& targets) const;
  /// [3k x u] Error of the fitted forces for each newton along a tangent that is not fitted
  /// (ObservableSubspace::unfitted). `covariance_N2`: of the same targets.
  fem::QpMatrix UnfittedError(const RowTargets& targets, const fem::QpMatrix& covariance_N2) const;
  /// G' W v [3k] of a displacement `v_m` of the rows, 1/N.
  fem::QpVector Projection(const RowTargets& targets,
                           const Eigen::Ref<const Eigen::VectorXd>& v_m) const;

 private:
  std::vector<FitSite> sites_;
  ActuatorCondensation condensation_;
  ObservableSubspace observable_;
  fem::QpMatrix prior_information_;
  fem::QpVector start_;
  Eigen::VectorXd misfit_m_;  ///< [rows]
  Eigen::VectorXd lambda_f_N_, lambda_a_N_;
};

}  // namespace palpate::force_estimation
