// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <functional>
#include <utility>

#include "libs/core/status.hpp"
#include "libs/fem/equilibrium_step.hpp"
#include "libs/fem/linearisation.hpp"
#include "libs/fem/load_state.hpp"
#include "libs/fem/time_budget.hpp"

namespace palpate::fem {

struct StaticSettings {
  /// ||r|| <= relative_tolerance * max(||f_ext||, ||F_int||, |lambda|), or rounding.
  double relative_tolerance = 1e-10;
  /// Distance by which g may exceed its bound, m.
  double constraint_tolerance_m = 1e-10;
  int max_newton_iterations = 40;  ///< in one load step
  /// Full Newton steps that are tried before the line search. Where they converge they take a tenth
  /// of its iterations: bending bodies must pass through stretched states that it refuses.
  int max_full_steps = 15;
  /// A tangent is kept for the next full step where the last one brought the residual down to this
  /// share of what it was, and from one Solve to the next; 0: every step has its own. For many
  /// equilibria near each other.
  double keep_tangent_below = 0.0;
  int max_load_steps = 60;  ///< tried in all
  double smallest_load_step = 1e-4;
};

struct StaticResult {
  Status status;
  int iterations = 0;       ///< Newton iterations over all load steps
  int load_steps = 0;       ///< that were accepted
  double residual_N = 0.0;  ///< Euclidean norm over the free directions
  double residual_relative = 0.0;
  double constraint_error_m = 0.0;
  double load_fraction = 0.0;  ///< of the way from the old loads to the new that was reached
  /// Multipliers where the last attempt ended, also where it failed (which cable pulls at its
  /// limit).
  Eigen::VectorXd multipliers_N;
};

/// Takes what has been reached so far, before each Newton iteration; false ends the solution with
/// kBudgetReached. Of the result, iterations, load_steps and load_fraction are current.
using StaticObserver = std::function<bool(const StaticResult&)>;

/// Newton's method for r(x, lambda) = 0 (linearisation.hpp): full steps first; where they fail, a
/// line search on the potential energy; where that fails, load stepping. No step inverts an
/// element, and only stable equilibria (K positive definite) count. Bounds on constraints are
/// solved in each step (equilibrium_step.hpp).
class StaticSolver {
 public:
  explicit StaticSolver(Linearisation& linearisation, const StaticSettings& settings = {});

  /// For all solutions from now on; empty: none.
  void SetObserver(StaticObserver observer) { observer_ = std::move(observer); }

  /// Rest shape, no load, every command off.
  StaticState RestState() const;

  /// Brings `state` into balance with `target`, from where it is. On failure `state` stays what it
  /// was at the last converged load step. kBudgetReached where `budget` was used up before.
  StaticResult Solve(const LoadState& target, StaticState* state, const TimeBudget& budget = {});

 private:
  enum class Steps { kFull, kLineSearch };

  Status SolveLoadStep(const LoadState& loads, const StaticState& start, StaticState* state,
                       StaticResult* result);
  Status Iterate(const LoadState& loads, Steps steps, StaticState* state, StaticResult* result);
  Status Linearise(const LoadState& loads, const StaticState& state, bool may_keep,
                   StaticResult* result);
  bool TakeFullStep(StaticState* state);
  LoadState Interpolate(const StaticState& start, const LoadState& target, double fraction) const;
  void ApplyFixedPositions(const LoadState& loads, Eigen::VectorXd* x_m) const;
  bool TakeStep(const LoadState& loads, double residual_before, StaticState* state);
  /// Of the last residual.
  double RelativeResidual(const LoadState& loads, const StaticState& state) const;
  /// Whether no step is needed. Not known near a state whose factor was shifted.
  bool IsBalanced(const LoadState& loads, const StaticState& state);
  bool HalvesTheResidual(const LoadState& loads, double residual_before, double error_before);
  double ConstraintError(const LoadState& loads, const StaticState& state) const;
  double Merit(const LoadState& loads, const Eigen::VectorXd& x_m, double* min_J) const;
  double MeritSlope(const LoadState& loads, const StaticState& state) const;

  Linearisation& linearisation_;
  StaticSettings settings_;
  EquilibriumStep step_;
  const TimeBudget* budget_ = nullptr;  ///< of the present Solve
  StaticObserver observer_;
  Eigen::VectorXd penalties_;
  StaticState trial_;
};

}  // namespace palpate::fem
