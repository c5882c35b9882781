// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "libs/core/status.hpp"

namespace palpate::calibration {

/// What one cable's drive can do: a factor of the paper's Omega.
struct CableLimits {
  double least_tension_N = 0.0;  ///< a cable cannot push
  double most_tension_N = std::numeric_limits<double>::infinity();
  /// Of the drive, m pulled in from the undeformed body on. A taut cable's displacement is the
  /// drive's; a slack one's is more than that, so that the most binds taut cables only.
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

/// Moves `lambda_a_N` [a], where the search starts, to the minimum. Tensions alone are bounds of
/// the QP; limits of displacement that its solution would break are added as rows, solved for in
/// the dual.
/// kTensionLimit: limits that no input keeps; kUnobservable: they bind and Q is singular;
/// kInvalidInput: limits that cross, or values that are not finite. On failure `lambda_a_N` stays.
Status SolveCableInputs(const CableInputProblem& problem, Eigen::VectorXd* lambda_a_N);

}  // namespace palpate::calibration
