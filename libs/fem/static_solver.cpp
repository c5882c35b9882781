// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/static_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/fem/constrained_tangent.hpp"

namespace palpate::fem {

namespace {

using Mode = ConstraintCommand::Mode;

/// By how much the value of a constraint misses its bound: what can only pull, where it is too
/// large, what can push, too, either way.
double Missed_m(const ConstraintCommand& command, double value, double multiplier_N) {
  const double excess = value - command.Bound_m(multiplier_N);
  return command.min_multiplier_N < 0.0 ? std::abs(excess) : std::max(0.0, excess);
}

/// Smaller load steps would not help.
bool IsFinal(const Status& status) {
  return status.code() == StatusCode::kTensionLimit || status.code() == StatusCode::kBudgetReached;
}

}  // namespace

StaticSolver::StaticSolver(Linearisation& linearisation, const StaticSettings& settings)
    : linearisation_(linearisation), settings_(settings), step_(linearisation) {
  penalties_ = Eigen::VectorXd::Zero(ToIndex(linearisation.constraints().size()));
}

StaticState StaticSolver::RestState() const {
  StaticState state;
  state.x_m = linearisation_.body().rest_m();
  state.multipliers_N = Eigen::VectorXd::Zero(ToIndex(linearisation_.constraints().size()));
  state.loads.external_force_N = Eigen::VectorXd::Zero(state.x_m.size());
  state.loads.commands.resize(linearisation_.constraints().size());
  state.loads.fixed_position_m = state.x_m;
  return state;
}

StaticResult StaticSolver::Solve(const LoadState& target, StaticState* state,
                                 const TimeBudget& budget) {
  StaticResult result;
  budget_ = &budget;
  PALPATE_CHECK(target.CommandCount() == state->multipliers_N.size(), target.CommandCount());
  StaticState start = *state;
  StaticState attempt = start;
  double remaining_fraction = 1.0;
  Status last = Status(StatusCode::kNotConverged, {});
  for (int tries = 0; tries < settings_.max_load_steps; ++tries) {
    // After a failure the rest of the way is taken in smaller pieces.
    const LoadState loads =
        remaining_fraction < 1.0 ? Interpolate(start, target, remaining_fraction) : target;
    last = SolveLoadStep(loads, start, &attempt, &result);
    result.multipliers_N = attempt.multipliers_N;
    if (last.ok()) {
      ++result.load_steps;
      attempt.loads = loads;
      start = attempt;
      result.load_fraction += (1.0 - result.load_fraction) * remaining_fraction;
      if (remaining_fraction >= 1.0) {
        *state = std::move(attempt);
        result.load_fraction = 1.0;
        result.status = Status::Ok();
        return result;
      }
      remaining_fraction = std::min(1.0, 2.0 * remaining_fraction / (1.0 - remaining_fraction));
      continue;
    }
    if (IsFinal(last)) break;
    remaining_fraction *= 0.5;
    if (remaining_fraction * (1.0 - result.load_fraction) < settings_.smallest_load_step) break;
  }
  *state = std::move(start);
  result.status = last.ok() ? Status(StatusCode::kNotConverged, "load steps used up") : last;
  return result;
}

LoadState StaticSolver::Interpolate(const StaticState& start, const LoadState& target,
                                    double fraction) const {
  LoadState loads = target;
  loads.external_force_N =
      (1.0 - fraction) * start.loads.external_force_N + fraction * target.external_force_N;
  loads.fixed_position_m =
      (1.0 - fraction) * start.loads.fixed_position_m + fraction * target.fixed_position_m;
  for (Eigen::Index c = 0; c < target.CommandCount(); ++c) {
    ConstraintCommand& command = loads.commands[At(c)];
    double from = start.multipliers_N[c];
    if (command.mode == Mode::kUpperBound) {
      from = linearisation_.constraints()[At(c)]->Value(start.x_m) -
             command.compliance_m_N * start.multipliers_N[c];
    } else if (command.mode == Mode::kOff) {
      command.mode = Mode::kMultiplier;
      command.value = 0.0;
    }
    command.value = (1.0 - fraction) * from + fraction * command.value;
  }
  return loads;
}

void StaticSolver::ApplyFixedPositions(const LoadState& loads, Eigen::VectorXd* x_m) const {
  const FixedDirections& fixed = linearisation_.fixed();
  for (Eigen::Index node = 0; node < fixed.cols(); ++node) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      if (fixed(i, node)) (*x_m)[3 * node + i] = loads.fixed_position_m[3 * node + i];
    }
  }
}

Status StaticSolver::SolveLoadStep(const LoadState& loads, const StaticState& start,
                                   StaticState* state, StaticResult* result) {
  *state = start;
  Status status = Iterate(loads, Steps::kFull, state, result);
  if (status.ok() || IsFinal(status)) return status;
  *state = start;
  return Iterate(loads, Steps::kLineSearch, state, result);
}

Status StaticSolver::Iterate(const LoadState& loads, Steps steps, StaticState* state,
                             StaticResult* result) {
  ApplyFixedPositions(loads, &state->x_m);
  EquilibriumStep::ImposeMultipliers(loads, &state->multipliers_N);
  const int most =
      steps == Steps::kFull ? settings_.max_full_steps : settings_.max_newton_iterations;
  // Steps with a tangent that is kept are cheap and count less.
  constexpr int kMostStepsPerTangent = 4;
  const int tangents_before = linearisation_.factor_count();
  const auto tangents = [&] { return linearisation_.factor_count() - tangents_before; };
  // A step with the tangent of another balance, where it leads as near as a kept one must.
  const auto helps = [&] {
    result->residual_relative = std::numeric_limits<double>::infinity();
    if (!Linearise(loads, *state, true, result).ok()) return false;
    const double before = result->residual_relative;
    if (before <= settings_.relative_tolerance) return true;
    const StaticState start = *state;
    const bool moved =
        TakeFullStep(state) &&
        linearisation_.UpdateResidual(state->x_m, state->multipliers_N, loads.external_force_N)
            .ok();
    if (moved && RelativeResidual(loads, *state) < settings_.keep_tangent_below * before)
      return true;
    *state = start;
    return false;
  };
  bool may_keep = steps == Steps::kFull && settings_.keep_tangent_below > 0.0 &&
                  (step_.HasTangentFor(loads) ? helps() : IsBalanced(loads, *state));
  for (int iteration = 0; iteration <= kMostStepsPerTangent * most; ++iteration) {
    if (Status status = Linearise(loads, *state, may_keep, result); !status.ok()) return status;
    result->constraint_error_m = ConstraintError(loads, *state);
    const bool balanced = result->residual_relative <= settings_.relative_tolerance ||
                          result->residual_N <= RoundingForce_N(linearisation_, state->x_m);
    if (balanced && result->constraint_error_m <= settings_.constraint_tolerance_m) {
      if (linearisation_.shifted() &&
          !IsStableUnderConstraints(linearisation_, loads, state->x_m, state->multipliers_N)) {
        return {StatusCode::kNotConverged, "the balance is unstable"};
      }
      return CheckLargestMultipliers(linearisation_, loads, state->x_m, state->multipliers_N,
                                     settings_.constraint_tolerance_m);
    }
    if (tangents() > most) break;
    if (budget_->Over()) return {StatusCode::kBudgetReached, "time used up"};
    if (observer_ && !observer_(*result)) return {StatusCode::kBudgetReached, "interrupted"};
    ++result->iterations;
    may_keep = steps == Steps::kFull;
    const bool moved = steps == Steps::kFull ? TakeFullStep(state)
                                             : TakeStep(loads, result->residual_relative, state);
    if (!moved) {
      return {StatusCode::kNotConverged, "no step brings the body nearer to equilibrium"};
    }
  }
  return {StatusCode::kNotConverged, "Newton iterations used up"};
}

/// The step from here, and the residual that it begins with. There is none where a kept tangent
/// has led to the balance.
Status StaticSolver::Linearise(const LoadState& loads, const StaticState& state, bool may_keep,
                               StaticResult* result) {
  const auto measure = [&] {
    result->residual_N = linearisation_.residual_N().norm();
    result->residual_relative = RelativeResidual(loads, state);
  };
  if (may_keep && settings_.keep_tangent_below > 0.0) {
    const double before = result->residual_relative;
    const Status known =
        linearisation_.UpdateResidual(state.x_m, state.multipliers_N, loads.external_force_N);
    if (!known.ok()) return known;
    measure();
    const bool balanced = result->residual_relative <= settings_.relative_tolerance;
    if (balanced && ConstraintError(loads, state) <= settings_.constraint_tolerance_m) {
      return Status::Ok();  // no step follows
    }
    if (balanced || result->residual_relative < settings_.keep_tangent_below * before) {
      return step_.ComputeChord(loads, state.x_m, state.multipliers_N);
    }
  }
  const Status status = step_.Compute(loads, state.x_m, state.multipliers_N, true);
  if (status.ok()) measure();
  return status;
}

/// The whole step, unless it inverts an element: then the largest of its halves that does not.
bool StaticSolver::TakeFullStep(StaticState* state) {
  constexpr double kShortestStep = 0.1;
  for (double length = 1.0; length >= kShortestStep; length *= 0.5) {
    step_.Apply(length, state->x_m, state->multipliers_N, &trial_.x_m, &trial_.multipliers_N);
    double min_J = 0.0;
    const double energy = linearisation_.body().Energy(trial_.x_m, &min_J);
    if (!(min_J > 0.0) || !std::isfinite(energy)) continue;
    state->x_m = trial_.x_m;
    state->multipliers_N = trial_.multipliers_N;
    return true;
  }
  return false;
}

/// Full Newton steps are taken as long as they bring the residual down; otherwise the step is
/// halved until the potential energy, with exact penalties for the bounds where it leads, falls.
bool StaticSolver::TakeStep(const LoadState& loads, double residual_before, StaticState* state) {
  for (Eigen::Index c = 0; c < penalties_.size(); ++c) {
    const double needed = 2.0 * std::max({step_.multipliers_N()[c], state->multipliers_N[c],
                                          -step_.multipliers_N()[c], -state->multipliers_N[c]});
    penalties_[c] = std::max(needed, 1e-3);
  }
  const double slope = MeritSlope(loads, *state);
  double min_J = 0.0;
  const double merit = Merit(loads, state->x_m, &min_J);
  const double error_before = ConstraintError(loads, *state);
  constexpr double kShortestStep = 1e-6;
  for (double length = 1.0; length >= kShortestStep; length *= 0.5) {
    step_.Apply(length, state->x_m, state->multipliers_N, &trial_.x_m, &trial_.multipliers_N);
    const double trial_merit = Merit(loads, trial_.x_m, &min_J);
    if (!(min_J > 0.0) || !std::isfinite(trial_merit)) continue;
    const bool accepted =
        trial_merit <= merit + 1e-4 * length * slope ||
        (length == 1.0 && HalvesTheResidual(loads, residual_before, error_before));
    if (accepted) {
      state->x_m = trial_.x_m;
      state->multipliers_N = trial_.multipliers_N;
      return true;
    }
  }
  return false;
}

double StaticSolver::RelativeResidual(const LoadState& loads, const StaticState& state) const {
  return linearisation_.residual_N().norm() /
         ForceScale_N(linearisation_, loads, state.multipliers_N);
}

bool StaticSolver::IsBalanced(const LoadState& loads, const StaticState& state) {
  return !linearisation_.shifted() &&
         linearisation_.UpdateResidual(state.x_m, state.multipliers_N, loads.external_force_N)
             .ok() &&
         RelativeResidual(loads, state) <= settings_.relative_tolerance &&
         ConstraintError(loads, state) <= settings_.constraint_tolerance_m;
}

bool StaticSolver::HalvesTheResidual(const LoadState& loads, double residual_before,
                                     double error_before) {
  const Status status =
      linearisation_.UpdateResidual(trial_.x_m, trial_.multipliers_N, loads.external_force_N);
  const double residual = RelativeResidual(loads, trial_);
  return status.ok() && residual <= 0.5 * residual_before + 1e-12 &&
         ConstraintError(loads, trial_) <= 0.5 * error_before + settings_.constraint_tolerance_m;
}

double StaticSolver::ConstraintError(const LoadState& loads, const StaticState& state) const {
  return ConstraintError_m(linearisation_, loads, state.x_m, state.multipliers_N);
}

double StaticSolver::Merit(const LoadState& loads, const Eigen::VectorXd& x_m,
                           double* min_J) const {
  double merit = linearisation_.body().Energy(x_m, min_J) -
                 loads.external_force_N.dot(x_m - linearisation_.body().rest_m());
  for (Eigen::Index c = 0; c < loads.CommandCount(); ++c) {
    const ConstraintCommand& command = loads.command(c);
    if (command.mode == Mode::kOff) continue;
    const double value = linearisation_.constraints()[At(c)]->Value(x_m);
    merit += command.mode == Mode::kMultiplier
                 ? command.value * value
                 : penalties_[c] * Missed_m(command, value, step_.multipliers_N()[c]);
  }
  return merit;
}

/// Bound on the merit's directional derivative along the step: the linearised bounds hold after
/// it.
double StaticSolver::MeritSlope(const LoadState& loads, const StaticState& state) const {
  double slope = -linearisation_.residual_N().dot(step_.dx());
  for (Eigen::Index c = 0; c < loads.CommandCount(); ++c) {
    const ConstraintCommand& command = loads.command(c);
    if (command.mode != Mode::kUpperBound) continue;
    // The residual holds lambda dg/dx already; the merit does not.
    slope += state.multipliers_N[c] * step_.gradient(c).dot(step_.dx());
    const double value = linearisation_.constraints()[At(c)]->Value(state.x_m);
    slope -= penalties_[c] * Missed_m(command, value, step_.multipliers_N()[c]);
  }
  return std::min(slope, 0.0);
}

}  // namespace palpate::fem
