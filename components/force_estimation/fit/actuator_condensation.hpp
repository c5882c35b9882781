// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/core/status.hpp"
#include "libs/fem/bounded_qp.hpp"
#include "libs/robot/compliance.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// Schur complement of the cable constraints, eqs. (13) and (14) of the paper: the linear response
/// of effectors and cables to contact forces under the cable inputs,
///   delta_e = G lambda_f + e0,   lambda_a = T lambda_f + t0.
/// A cable of prescribed displacement is taut (it has that displacement) or slack (it has no
/// tension). Which of them is part of the solution; Settle finds it.
class ActuatorCondensation {
 public:
  ActuatorCondensation(int effector_rows, const std::vector<robot::ActuatorTraits>& traits);

  /// Begins with the cables taut that have a tension in `lambda_a_N` [a].
  void Start(const std::vector<robot::ActuatorCommand>& commands,
             const Eigen::VectorXd& lambda_a_N);

  /// Computes the response for the present set of taut cables. kUnobservable where the
  /// compliances of taut cables are linearly dependent.
  Status Condense(const robot::Compliance& compliance,
                  const std::vector<robot::ActuatorCommand>& commands);

  /// Whether every actuator is taut or slack as assumed under lambda_f; else changes the set, and
  /// Condense must be called again. A cable is changed at most a few times, so this ends.
  bool Settle(const robot::Compliance& compliance,
              const std::vector<robot::ActuatorCommand>& commands,
              const Eigen::VectorXd& lambda_f_N);

  const Eigen::MatrixXd& G() const { return G_; }      ///< [3e x f] m/N
  const Eigen::VectorXd& e0_m() const { return e0_; }  ///< [3e]
  /// Cable tensions under these contact forces, N.
  void CableForces(const Eigen::VectorXd& lambda_f_N, Eigen::VectorXd* lambda_a_N) const;
  /// Corrects an additional displacement of the effectors, with which the cables move by
  /// `cable_motion_m` [a], for taut cables that keep their length: e - W_ea W_TT^-1 a_T.
  void HoldTautCables(const robot::Compliance& compliance, const Eigen::VectorXd& cable_motion_m,
                      Eigen::VectorXd* effector_motion_m) const;

 private:
  /// [a] imposed tensions, N. Under displacement control 0 where taut, else the least.
  Eigen::VectorXd fixed_;
  std::vector<double> least_force_N_;  ///< [a] at which a cable is slack, a chamber at a vacuum
  std::vector<int> taut_;              ///< cables whose displacement is imposed
  std::vector<int> changes_;
  fem::QpMatrix inverse_TT_;
  fem::QpMatrix T_taut_;   ///< [taut x f]
  fem::QpVector t0_taut_;  ///< [taut]
  Eigen::MatrixXd G_;
  Eigen::VectorXd e0_;
  Eigen::VectorXd lambda_a_, delta_a_;
};

}  // namespace palpate::force_estimation
