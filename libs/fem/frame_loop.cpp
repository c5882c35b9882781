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
/// the last one did.
void TakeChordSteps(FrameProblem& problem, double tolerance, const TimeBudget& budget,
                    FrameOutcome* outcome) {
  double expected = 0.0;
  while (expected <= tolerance && outcome->error > tolerance && !budget.Over()) {
    if (!problem.PrepareChordStep().ok() || !problem.Try(1.0, budget.Over()).ok()) return;
    const double ratio = problem.TrialError() / outcome->error;
    if (!(ratio < kChordGuard)) return;
    problem.AcceptTrial();
    ++outcome->chord_steps;
    outcome->error = problem.TrialError();
    expected = ratio * outcome->error;
  }
}

/// Chord steps with the factor of an earlier frame. True where they led within the tolerance.
bool ConvergeWithKeptFactor(FrameProblem& problem, double tolerance, const TimeBudget& budget,
                            FrameOutcome* outcome) {
  if (!problem.PrepareKeptStep().ok()) return false;
  outcome->error = problem.StartError();
  while (outcome->error > tolerance) {
    if (budget.Over() || !problem.Try(1.0, false).ok()) return false;
    const double wanted = std::max(tolerance, kChordGuard * outcome->error);
    if (!(problem.TrialError() <= wanted)) return false;
    problem.AcceptTrial();
    ++outcome->chord_steps;
    outcome->error = problem.TrialError();
  }
  outcome->status = Status::Ok();
  return true;
}

}  // namespace

FrameOutcome RunFrame(FrameProblem& problem, const FrameSettings& settings,
                      const TimeBudget& budget) {
  FrameOutcome outcome;
  if (settings.keep_factor &&
      ConvergeWithKeptFactor(problem, settings.relative_tolerance, budget, &outcome)) {
    return outcome;
  }
  double smallest_error = std::numeric_limits<double>::infinity();
  int steps_without_gain = 0;
  while (outcome.exact_steps < settings.max_exact_steps) {
    const double begin_s = budget.Elapsed_s();
    outcome.status = TakeExactStep(problem, budget, &outcome);
    if (!outcome.status.ok()) return outcome;
    const double exact_step_s = budget.Elapsed_s() - begin_s;
    TakeChordSteps(problem, settings.relative_tolerance, budget, &outcome);
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
