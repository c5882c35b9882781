// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "libs/core/status.hpp"

namespace palpate::calibration {

/// Limits of one cable and its actuator: a factor of the paper's Omega.
struct CableLimits {
  double least_tension_N = 0.0;  ///< a cable cannot push
  double most_tension_N = std::numeric_limits<double>::infinity();
  /// Of the actuator, m pulled in since the undeformed body. A taut cable has the displacement of
  /// its actuator and a slack one more, so that the upper limit applies to taut cables only.
  double least_displacement_m = -std::numeric_limits<double>::infinity();
  double most_displacement_m = std::numeric_limits<double>::infinity();
};

/// Eq. (9) about one linearised state: min 1/2 lambda' Q lambda + c' lambda over Omega, with
/// delta_a = W_aa lambda + delta_a^free (eq. (4)).
struct CableInputProblem {
  Eigen::MatrixXd Q;                ///< [a x a] 1/N^2
  Eigen::VectorXd c;                ///< [a] 1/N
  Eigen::MatrixXd W_aa;             ///< [a x a] m/N
  Eigen::VectorXd delta_a_free_m;   ///< [a]
  std::vector<CableLimits> limits;  ///< [a]
};

/// Moves `lambda_a_N` [a], the initial point, to the minimum. Tension limits are bounds of the QP.
/// Displacement limits that its solution violates are added as rows and solved in the dual.
/// kTensionLimit: no input satisfies the limits; kUnobservable: limits are active and Q is
/// singular; kInvalidInput: limits that cross, or values that are not finite. On failure
/// `lambda_a_N` stays.
Status SolveCableInputs(const CableInputProblem& problem, Eigen::VectorXd* lambda_a_N);

}  // namespace palpate::calibration
