// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/core/status.hpp"
#include "libs/fem/bounded_qp.hpp"
#include "libs/fem/linearisation.hpp"
#include "libs/fem/load_state.hpp"

namespace palpate::fem {

/// Newton's step of a loaded body from a state towards equilibrium: dx = K^-1 r + K^-1 H_a' dlambda
/// (paper, eq. 6), the multipliers from delta_a = W_aa lambda + delta_a^free (eq. 4) under their
/// bounds, W_aa = H_a K^-1 H_a' plus the compliance of the bounds, as a bounded QP. Nothing is
/// allocated after construction.
class EquilibriumStep {
 public:
  explicit EquilibriumStep(Linearisation& linearisation);

  /// Puts the multipliers that `loads` prescribes into `multipliers_N`.
  static void ImposeMultipliers(const LoadState& loads, Eigen::VectorXd* multipliers_N);

  /// With a new tangent at the state. Where `allow_shift`, see Linearisation::Update.
  Status Compute(const LoadState& loads, const Eigen::VectorXd& x_m,
                 const Eigen::VectorXd& multipliers_N, bool allow_shift);
  /// With the factor and W_aa of the last Compute, for the residual that the linearisation was
  /// updated with at this state (Linearisation::UpdateResidual).
  Status ComputeChord(const LoadState& loads, const Eigen::VectorXd& x_m,
                      const Eigen::VectorXd& multipliers_N);

  /// Whether ComputeChord can be asked for these loads: the linearisation's factor is still,
  /// unshifted, that of the last Compute, and the constraints under kUpperBound are the same.
  bool HasTangentFor(const LoadState& loads) const;

  const Eigen::VectorXd& dx() const { return step_; }  ///< [Size], reduced
  /// [constraints] where the step leads.
  const Eigen::VectorXd& multipliers_N() const { return multipliers_; }
  /// -dg/dx [Size] of constraint c, which must be under kUpperBound; of the last Compute.
  auto gradient(Eigen::Index c) const { return gradients_.col(c); }

  /// The state that `length` times the step leads to.
  void Apply(double length, const Eigen::VectorXd& x_m, const Eigen::VectorXd& multipliers_N,
             Eigen::VectorXd* new_x_m, Eigen::VectorXd* new_multipliers_N) const;

 private:
  Status SolveMultipliers(const LoadState& loads, const Eigen::VectorXd& x_m,
                          const Eigen::VectorXd& multipliers_N);

  Linearisation& linearisation_;
  Eigen::MatrixXd columns_;    ///< [Size x constraints + 1]: -K^-1 dg/dx, K^-1 r
  Eigen::MatrixXd gradients_;  ///< [Size x constraints]: -dg/dx
  Eigen::VectorXd nodal_;      ///< [3n]
  Eigen::VectorXd step_;
  Eigen::VectorXd multipliers_;
  std::vector<bool> bounded_;  ///< [constraints] in the last Compute that succeeded
  int factor_ = -1;            ///< Linearisation::factor_count() after it
};

/// Distance by which the bounds are missed at a state, m: a taut constraint (multiplier above its
/// least) by either sign, a slack one where it is too long. One at its largest multiplier is not
/// counted.
double ConstraintError_m(const Linearisation& linearisation, const LoadState& loads,
                         const Eigen::VectorXd& x_m, const Eigen::VectorXd& multipliers_N);

/// The size of the forces that a residual is to be compared with, N: external, internal (of the
/// last update of `linearisation`) or multipliers, whichever is largest.
double ForceScale_N(const Linearisation& linearisation, const LoadState& loads,
                    const Eigen::VectorXd& multipliers_N);

/// Force that rounding of the positions alone makes, N: eps |x| times a typical stiffness.
double RoundingForce_N(const Linearisation& linearisation, const Eigen::VectorXd& x_m);

/// kTensionLimit where a bound is missed although its multiplier is at its largest.
Status CheckLargestMultipliers(const Linearisation& linearisation, const LoadState& loads,
                               const Eigen::VectorXd& x_m, const Eigen::VectorXd& multipliers_N,
                               double tolerance_m);

}  // namespace palpate::fem
