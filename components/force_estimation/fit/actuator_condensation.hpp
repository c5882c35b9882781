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

/// The body's linear response to contact forces with the cable inputs imposed, eqs. (13) and (14)
/// of the paper solved for the cables beforehand:
///   delta_e = G lambda_f + e0,   lambda_a = T lambda_f + t0.
/// A cable under displacement control is taut (its displacement is the commanded one) or slack (no
/// tension); which, is part of the solution and is found by Settle.
class ActuatorCondensation {
 public:
  ActuatorCondensation(int effector_rows, int cables);

  /// Starts from the cables that pull in `lambda_a_N`.
  void Start(const std::vector<robot::CableCommand>& commands, const Eigen::VectorXd& lambda_a_N);

  /// Computes the response for the present set of taut cables. kUnobservable where two taut cables
  /// act alike.
  Status Eliminate(const robot::Compliance& compliance,
                   const std::vector<robot::CableCommand>& commands);

  /// Whether lambda_f leaves every cable as it was assumed; otherwise changes the set, and
  /// Eliminate must be called again. A cable is changed at most a few times, so this ends.
  bool Settle(const robot::Compliance& compliance, const std::vector<robot::CableCommand>& commands,
              const Eigen::VectorXd& lambda_f_N);

  const Eigen::MatrixXd& G() const { return G_; }      ///< [3e x f] m/N
  const Eigen::VectorXd& e0_m() const { return e0_; }  ///< [3e]
  /// lambda_a for these contact forces, N.
  void CableForces(const Eigen::VectorXd& lambda_f_N, Eigen::VectorXd* lambda_a_N) const;
  /// How an additional motion of the effectors, and of the cables, arrives at the effectors when
  /// the taut cables hold their length: e - W_ea W_TT^-1 a_T.
  void HoldTautCables(const robot::Compliance& compliance, const Eigen::VectorXd& cable_motion_m,
                      Eigen::VectorXd* effector_motion_m) const;

 private:
  Eigen::VectorXd fixed_;  ///< [a] imposed tensions, N; 0 for cables under displacement control
  std::vector<int> taut_;  ///< cables whose displacement is imposed
  std::vector<int> changes_;
  fem::QpMatrix inverse_TT_;
  fem::QpMatrix T_taut_;   ///< [taut x f]
  fem::QpVector t0_taut_;  ///< [taut]
  Eigen::MatrixXd G_;
  Eigen::VectorXd e0_;
  Eigen::VectorXd lambda_a_, delta_a_;
};

}  // namespace palpate::force_estimation
