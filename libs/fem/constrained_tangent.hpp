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
///   K dx = r + H dlambda,  H' dx + C dlambda = b.
/// C is diagonal. A constraint that yields (a gas, a stretching cable) has a compliance there: it
/// stiffens K by H C^-1 H' in place of holding a motion. By projected conjugate gradients (Gould,
/// Hribar and Nocedal 2001), preconditioned by the factor of the shifted K that `linearisation`
/// has. A direction of negative curvature that they meet says that the body is not stable.
class ConstrainedTangent {
 public:
  /// `linearisation` must outlive it and be shifted() at the state; `H` [Size x constraints], none
  /// of which depends on others; `compliance_m_N` [constraints], >= 0.
  ConstrainedTangent(Linearisation& linearisation, Eigen::MatrixXd H,
                     Eigen::VectorXd compliance_m_N);

  /// `r` [Size], `b` [constraints]. kNotPositiveDefinite where the body is not stable,
  /// kNotConverged where the iterations are used up.
  Status Solve(const Eigen::VectorXd& r, const Eigen::VectorXd& b, Eigen::VectorXd* dx,
               Eigen::VectorXd* dlambda) const;

 private:
  /// (K + H C^-1 H') v, without the shift; C^-1 of the constraints that yield.
  Eigen::VectorXd Times(const Eigen::VectorXd& v) const;
  Eigen::VectorXd Project(const Eigen::VectorXd& residual) const;
  Eigen::VectorXd MultipliersOf(const Eigen::VectorXd& residual) const;

  Linearisation& linearisation_;
  Eigen::MatrixXd H_;
  Eigen::VectorXd stiffness_N_m_;  ///< [constraints] 1 / compliance; 0 where there is none
  Eigen::MatrixXd moved_;          ///< of the shifted K, its inverse times H
  Eigen::MatrixXd schur_;          ///< H' moved + C
  double shift_N_m_ = 0.0;
};

/// Whether a balance whose tangent was shifted is stable under the constraints that `loads` hold at
/// their bounds, as far as these yield, and that can both push and pull.
bool IsStableUnderConstraints(Linearisation& linearisation, const LoadState& loads,
                              const Eigen::VectorXd& x_m, const Eigen::VectorXd& multipliers_N);

/// Those constraints; a shifted tangent needs at least one. None where one has a compliance below
/// 0.
std::vector<Eigen::Index> HeldConstraints(const LoadState& loads,
                                          const Eigen::VectorXd& multipliers_N);

}  // namespace palpate::fem
