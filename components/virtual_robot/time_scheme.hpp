// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

namespace palpate::virtual_robot {

/// Where the nodes are and how they move; each [3n].
struct MotionState {
  Eigen::VectorXd x_m;
  Eigen::VectorXd v_m_s;
  Eigen::VectorXd a_m_s2;
};

/// One step of the generalised-alpha method (J. Chung, G. M. Hulbert, A time integration algorithm
/// for structural dynamics with improved numerical dissipation, J. Appl. Mech. 60, 1993), inner
/// forces taken at the intermediate position (1 - alpha_f) x_1 + alpha_f x_0. A spectral radius of
/// 1 makes it the implicit midpoint rule. Without inertia: the balance at the end of the step.
struct TimeScheme {
  bool dynamic = false;
  double h_s = 0.0;
  double alpha_m = 0.0;
  double alpha_f = 0.0;
  double beta = 0.0;
  double gamma = 0.0;

  static TimeScheme QuasiStatic(double h_s);
  /// `spectral_radius` in [0, 1]: what is left of the highest frequencies after a step.
  static TimeScheme GeneralisedAlpha(double h_s, double spectral_radius);

  bool conserving() const { return dynamic && alpha_m == 0.5; }
  /// From the start of the step to the instant at which it is balanced.
  double balance_s() const { return (1.0 - alpha_f) * h_s; }
  /// Derivatives of the intermediate position, velocity and acceleration by x_1.
  double PositionRate() const { return 1.0 - alpha_f; }
  double VelocityRate() const { return (1.0 - alpha_f) * gamma / (beta * h_s); }
  double AccelerationRate() const { return (1.0 - alpha_m) / (beta * h_s * h_s); }

  /// Newmark's formulas: sets velocity and acceleration of `to` from its position. Without inertia
  /// the mean velocity, and none.
  void SetRates(const MotionState& from, MotionState* to) const;
  /// Where the nodes go if they are left to themselves: constant acceleration; without inertia,
  /// constant velocity.
  void Predict(const MotionState& from, Eigen::VectorXd* x_m) const;
};

}  // namespace palpate::virtual_robot
