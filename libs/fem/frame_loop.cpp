// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/frame_loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::fem {

namespace {

constexpr double kShortestStep = 1.0 / 64.0;
constexpr double kChordGuard = 0.3;
/// The same where no exact step is possible any more.
constexpr double kLastChordGuard = 0.7;
/// Exact steps in which the error may stay above the smallest one before.
constexpr int kPatience = 4;

/// The step, or the largest of its halves that inverts no element.
Status TakeExactStep(FrameProblem& problem, const TimeBudget& budget, FrameOutcome* outcome) {
  Status status = problem.PrepareExactStep();
  if (!status.ok()) return status;
  ++outcome->exact_steps;
  for (double length = 1.0; length >= kShortestStep; length *= 0.5) {
    status = problem.Try(length, budget.Over());
    if (status.code() != StatusCode::kInverted) break;
  }
  if (!status.ok()) return status;
  if (!std::isfinite(problem.TrialError())) return {StatusCode::kNotConverged, {}};
  problem.AcceptTrial();
  outcome->error = problem.TrialError();
  return status;
}

/// One chord step, and others as long as they would lead within the tolerance if they gained what
/// the last one did; where no exact step can follow, as long as they gain anything to speak of.
void TakeChordSteps(FrameProblem& problem, double tolerance, const TimeBudget& budget,
                    double exact_step_s, FrameOutcome* outcome) {
  double expected = 0.0;
  while (outcome->error > tolerance && !budget.Over()) {
    const bool no_exact_step = budget.Over(exact_step_s);
    if (expected > tolerance && !no_exact_step) return;
    if (!problem.PrepareChordStep().ok() || !problem.Try(1.0, budget.Over()).ok()) return;
    const double ratio = problem.TrialError() / outcome->error;
    if (!(ratio < (no_exact_step ? kLastChordGuard : kChordGuard))) return;
    problem.AcceptTrial();
    ++outcome->chord_steps;
    outcome->error = problem.TrialError();
    expected = ratio * outcome->error;
  }
}

/// Chord steps with the factor of an earlier frame. True where they led within the tolerance, or
/// where the budget allows no other step.
bool EndsWithKeptFactor(FrameProblem& problem, const FrameSettings& settings,
                        const TimeBudget& budget, FrameOutcome* outcome) {
  if (!problem.PrepareKeptStep().ok()) return false;
  outcome->error = problem.StartError();
  while (outcome->error > settings.relative_tolerance) {
    const bool no_exact_step =
        settings.exact_step_cost_s > 0.0 && budget.Over(settings.exact_step_cost_s);
    const double begin_s = budget.Elapsed_s();
    const double wanted = std::max(settings.relative_tolerance, kLastChordGuard * outcome->error);
    if (budget.Over() || !problem.Try(1.0, false).ok() || !(problem.TrialError() <= wanted)) {
      outcome->status = Status(StatusCode::kBudgetReached, "time used up");
      return no_exact_step;
    }
    const double ratio = problem.TrialError() / outcome->error;
    problem.AcceptTrial();
    ++outcome->chord_steps;
    outcome->error = problem.TrialError();
    const double left_s = (budget.Elapsed_s() - begin_s) *
                          std::log(settings.relative_tolerance / outcome->error) / std::log(ratio);
    const double exact_s = settings.exact_step_cost_s;
    const bool worth_it = exact_s > 0.0 ? left_s < exact_s : ratio < kChordGuard;
    if (outcome->error > settings.relative_tolerance && !worth_it && !no_exact_step) return false;
  }
  outcome->status = Status::Ok();
  return true;
}

}  // namespace

FrameOutcome RunFrame(FrameProblem& problem, const FrameSettings& settings,
                      const TimeBudget& budget) {
  FrameOutcome outcome;
  if (settings.keep_factor && EndsWithKeptFactor(problem, settings, budget, &outcome)) {
    return outcome;
  }
  double smallest_error = std::numeric_limits<double>::infinity();
  int steps_without_gain = 0;
  while (outcome.exact_steps < settings.max_exact_steps) {
    const double begin_s = budget.Elapsed_s();
    outcome.status = TakeExactStep(problem, budget, &outcome);
    if (!outcome.status.ok()) return outcome;
    const double exact_step_s = std::max(settings.exact_step_cost_s, budget.Elapsed_s() - begin_s);
    TakeChordSteps(problem, settings.relative_tolerance, budget, exact_step_s, &outcome);
    if (outcome.error <= settings.relative_tolerance) return outcome;
    steps_without_gain = outcome.error < smallest_error ? 0 : steps_without_gain + 1;
    if (steps_without_gain == kPatience) {
      outcome.status = Status(StatusCode::kNotConverged, {});
      return outcome;
    }
    smallest_error = std::min(smallest_error, outcome.error);
    if (budget.Over(exact_step_s)) break;
  }
  const bool steps = outcome.exact_steps == settings.max_exact_steps;
  outcome.status = Status(StatusCode::kBudgetReached, steps ? "steps used up" : "time used up");
  return outcome;
}

}  // namespace palpate::fem
