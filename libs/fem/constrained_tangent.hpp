// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/core/status.hpp"
#include "libs/fem/linearisation.hpp"
#include "libs/fem/load_state.hpp"

namespace palpate::fem {

/// Newton's step of a body that is stable only because constraints are held: a balloon beyond its
/// largest pressure, whose volume is. Its tangent K has no Cholesky factor, but is positive
/// definite along the motions that keep the constraints,
///   K dx = r + H dlambda,  H' dx = b.
/// By projected conjugate gradients (Gould, Hribar and Nocedal 2001), preconditioned by the factor
/// of the shifted K that `linearisation` has. A direction of negative curvature that they meet says
/// that the body is not stable.
class ConstrainedTangent {
 public:
  /// `linearisation` must outlive it and be shifted() at the state; `H` [Size x constraints], none
  /// of which depends on others.
  ConstrainedTangent(Linearisation& linearisation, Eigen::MatrixXd H);

  /// `r` [Size], `b` [constraints]. kNotPositiveDefinite where the body is not stable,
  /// kNotConverged where the iterations are used up.
  Status Solve(const Eigen::VectorXd& r, const Eigen::VectorXd& b, Eigen::VectorXd* dx,
               Eigen::VectorXd* dlambda) const;

 private:
  Eigen::VectorXd Times(const Eigen::VectorXd& v) const;  ///< K v, without the shift
  Eigen::VectorXd Project(const Eigen::VectorXd& residual) const;
  Eigen::VectorXd MultipliersOf(const Eigen::VectorXd& residual) const;

  Linearisation& linearisation_;
  Eigen::MatrixXd H_;
  Eigen::MatrixXd moved_;  ///< of the shifted K, its inverse times H
  Eigen::MatrixXd schur_;  ///< H' moved
  double shift_N_m_ = 0.0;
};

/// Whether a balance whose tangent was shifted is stable under the constraints that `loads` hold at
/// their bounds and that can both push and pull.
bool IsStableUnderConstraints(Linearisation& linearisation, const LoadState& loads,
                              const Eigen::VectorXd& x_m, const Eigen::VectorXd& multipliers_N);

/// Those constraints; a shifted tangent needs at least one.
std::vector<Eigen::Index> HeldConstraints(const LoadState& loads,
                                          const Eigen::VectorXd& multipliers_N);

}  // namespace palpate::fem
