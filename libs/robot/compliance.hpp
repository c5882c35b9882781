// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/interpolation_weights.hpp"
#include "libs/fem/linearisation.hpp"
#include "libs/robot/observation_row.hpp"

namespace palpate::robot {

/// A direction in which an external force may act: one row of the paper's H_f. The force f on it
/// gives node k the force weights[k] * f * direction.
struct ForceDirection {
  fem::InterpolationWeights weights;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< unit, robot frame

  void AddForce(double force_N, Eigen::VectorXd& nodal_force_N) const;
};

/// The compliance matrices of the paper's eq. (5), W_ij = H_i K^-1 H_j', about one linearised
/// state, for effectors e (observed scalars), cables a and external forces f. Columns are computed
/// for forces and cables only, from one factorisation: effectors are rows, so many cost what few
/// cost.
///
/// Cables are the linearisation's constraints. Their displacement delta_a is counted as pulled in,
/// so dell/dx = -H_a. After the first Compute of a set of force directions nothing is allocated.
class Compliance {
 public:
  Compliance(fem::Linearisation& linearisation, std::vector<ObservationRow> effectors);

  /// Other rows of H_e. The W of the last Compute belong to the old ones until Observe.
  void SetEffectors(std::vector<ObservationRow> effectors);
  const std::vector<ObservationRow>& effectors() const { return effectors_; }

  /// Sets the rows of H_f. Positions of the directions in `forces` index lambda_f.
  void SetForces(std::vector<ForceDirection> forces);
  const std::vector<ForceDirection>& forces() const { return forces_; }

  /// Computes everything about the state, at which `linearisation` was updated last.
  /// `actuator_rest_m` [a]; lambda_a [a] and lambda_f [f] are the forces that the state's
  /// residual was computed with, N.
  void Compute(const Eigen::VectorXd& x_m, const Eigen::VectorXd& actuator_rest_m,
               const Eigen::VectorXd& lambda_a_N, const Eigen::VectorXd& lambda_f_N);
  /// The same at another state, with the W of the last Compute (a chord step): only the residual,
  /// which `linearisation` must have updated there, is solved for, with the old factor.
  void ComputeChord(const Eigen::VectorXd& x_m, const Eigen::VectorXd& actuator_rest_m,
                    const Eigen::VectorXd& lambda_a_N, const Eigen::VectorXd& lambda_f_N);

  /// What the effectors set since see of the columns of the last Compute or ComputeChord.
  void Observe(const Eigen::VectorXd& x_m, const Eigen::VectorXd& actuator_rest_m);

  /// Solves for the effectors, about the state of the last Compute: K is symmetric, so that the
  /// columns K^-1 H_e' give W of any forces (Maxwell's and Betti's reciprocity).
  void PrepareReciprocity();
  /// Sets W_ef and W_af of the forces set since, by the columns of PrepareReciprocity: no solve for
  /// each force. The free values stay those of the last Compute. To be called before another one.
  void ObserveByReciprocity();

  const Eigen::MatrixXd& W_ea() const { return W_ea_; }                    ///< [e x a] m/N
  const Eigen::MatrixXd& W_ef() const { return W_ef_; }                    ///< [e x f] m/N
  const Eigen::MatrixXd& W_aa() const { return W_aa_; }                    ///< [a x a] m/N
  const Eigen::MatrixXd& W_af() const { return W_af_; }                    ///< [a x f] m/N
  const Eigen::VectorXd& delta_e_free_m() const { return delta_e_free_; }  ///< [e]
  const Eigen::VectorXd& delta_a_free_m() const { return delta_a_free_; }  ///< [a]

  /// Eq. (3): delta_e = W_ea lambda_a + W_ef lambda_f + delta_e^free, values of the effectors.
  void EffectorPositions(const Eigen::VectorXd& lambda_a_N, const Eigen::VectorXd& lambda_f_N,
                         Eigen::VectorXd* delta_e_m) const;
  /// Eq. (4): delta_a = W_aa lambda_a + W_af lambda_f + delta_a^free, displacements of the cables.
  void CableDisplacements(const Eigen::VectorXd& lambda_a_N, const Eigen::VectorXd& lambda_f_N,
                          Eigen::VectorXd* delta_a_m) const;
  /// Eq. (6): moves `x_m` [3n] by fraction * (K^-1 r + K^-1 H_a' dlambda_a + K^-1 H_f' dlambda_f).
  void UpdateConfiguration(const Eigen::VectorXd& lambda_a_N, const Eigen::VectorXd& lambda_f_N,
                           double fraction, Eigen::VectorXd* x_m);

 private:
  void FillColumns(const Eigen::VectorXd& x_m);
  double AlongCable(Eigen::Index cable, const Eigen::Ref<const Eigen::VectorXd>& column) const;
  void ObserveColumns();
  void ObserveResponse(const Eigen::VectorXd& x_m, const Eigen::VectorXd& actuator_rest_m);

  fem::Linearisation& linearisation_;
  std::vector<ObservationRow> effectors_;
  std::vector<ForceDirection> forces_;
  Eigen::MatrixXd directions_;                         ///< [reduced x a + f], H_a' and H_f'
  std::vector<std::vector<Eigen::Index>> cable_rows_;  ///< [a] nonzeros of H_a'
  Eigen::MatrixXd columns_;     ///< [reduced x 1 + a + f], K^-1 of r, H_a', H_f'
  Eigen::MatrixXd reciprocal_;  ///< [reduced x e + a], K^-1 of H_e', H_a'
  Eigen::VectorXd nodal_;       ///< [3n]
  Eigen::VectorXd step_;        ///< [reduced]
  Eigen::VectorXd lambda_a_, lambda_f_;
  Eigen::MatrixXd W_ea_, W_ef_, W_aa_, W_af_;
  Eigen::VectorXd delta_e_free_, delta_a_free_;
};

}  // namespace palpate::robot
