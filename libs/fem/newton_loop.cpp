// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/newton_loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::fem {

namespace {

constexpr double kShortestStep = 1.0 / 64.0;
constexpr double kChordGuard = 0.3;
/// The same where no exact step is possible any more.
constexpr double kLastChordGuard = 0.7;
/// By which the first step with a kept factor, and one that was cut, may raise the error.
constexpr double kMostRise = 6.0;
/// Cut steps with one factor.
constexpr int kMostCutSteps = 2;
/// Exact steps in which the error may stay above the smallest one before.
constexpr int kPatience = 4;

/// The step, or the largest of its halves that inverts no element.
Status TakeExactStep(NewtonProblem& problem, const TimeBudget& budget, FrameOutcome* outcome) {
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

/// Chord steps with one factor, each judged by what it gains.
class ChordSteps {
 public:
  /// `exact_step_s`: what an exact step would cost. Where the settings say so beforehand, chord
  /// steps go on as long as they are cheaper.
  ChordSteps(NewtonProblem& problem, const FrameSettings& settings, const TimeBudget& budget,
             double exact_step_s, FrameOutcome* outcome)
      : problem_(problem),
        settings_(settings),
        budget_(budget),
        exact_step_s_{exact_step_s},
        cost_known_{settings.exact_step_cost_s > 0.0},
        outcome_(outcome) {}

  bool Converged() const { return outcome_->error <= settings_.relative_tolerance; }
  bool NoExactStepCanFollow() const { return budget_.Over(exact_step_s_); }
  bool cost_known() const { return cost_known_; }
  bool was_cut() const { return was_cut_; }

  /// False where the step failed, or its error is above `guard` times the last one (and above
  /// `enough`): the state stays. A step that was cut says little, so it may raise the error.
  bool Take(double guard, double enough, bool last) {
    const double begin_s = cost_known_ ? budget_.Elapsed_s() : 0.0;
    if (!problem_.Try(1.0, last).ok()) return false;
    was_cut_ = cost_known_ && problem_.StepWasCut() && cut_steps_++ < kMostCutSteps;
    ratio_ = problem_.TrialError() / outcome_->error;
    const bool gains = ratio_ <= (was_cut_ ? kMostRise : guard);
    if (!gains && !(problem_.TrialError() <= enough)) return false;
    problem_.AcceptTrial();
    ++outcome_->chord_steps;
    outcome_->error = problem_.TrialError();
    if (cost_known_) step_s_ = budget_.Elapsed_s() - begin_s;
    return true;
  }
  double ratio() const { return ratio_; }  ///< of the errors after and before the last step

  /// Whether as many more as are needed, gaining what the last one did, cost less than an exact
  /// step.
  bool AreWorthIt() const {
    return ratio_ < 1.0 &&
           step_s_ * std::log(settings_.relative_tolerance / outcome_->error) / std::log(ratio_) <
               exact_step_s_;
  }

 private:
  NewtonProblem& problem_;
  const FrameSettings& settings_;
  const TimeBudget& budget_;
  double exact_step_s_;
  bool cost_known_;
  FrameOutcome* outcome_;
  int cut_steps_ = 0;
  bool was_cut_ = false;
  double ratio_ = 0.0;
  double step_s_ = 0.0;
};

/// One chord step after an exact one, and others as long as they would lead within the tolerance if
/// they gained what the last one did, or are cheaper than an exact step of a known cost; where no
/// exact step can follow, as long as they gain anything to speak of.
void TakeChordSteps(NewtonProblem& problem, const FrameSettings& settings, const TimeBudget& budget,
                    double exact_step_s, FrameOutcome* outcome) {
  ChordSteps steps(problem, settings, budget, exact_step_s, outcome);
  bool go_on = true;
  while (!steps.Converged() && !budget.Over()) {
    const bool no_exact_step = steps.NoExactStepCanFollow();
    if (!go_on && !no_exact_step) return;
    const double guard = steps.cost_known() || no_exact_step ? kLastChordGuard : kChordGuard;
    if (!problem.PrepareChordStep().ok() || !steps.Take(guard, 0.0, budget.Over())) return;
    go_on = steps.cost_known() ? steps.was_cut() || steps.AreWorthIt()
                               : steps.ratio() * outcome->error <= settings.relative_tolerance;
  }
}

/// Chord steps with the factor of an earlier frame. True where they led within the tolerance, or
/// where the budget allows no other step. The first may raise the error, as Newton's may: bodies
/// that bend pass through stretched states, whatever the factor.
bool EndsWithKeptFactor(NewtonProblem& problem, const FrameSettings& settings,
                        const TimeBudget& budget, FrameOutcome* outcome) {
  if (!problem.PrepareFrozenFactorStep().ok()) return false;
  outcome->error = problem.StartError();
  ChordSteps steps(problem, settings, budget, settings.exact_step_cost_s, outcome);
  bool first = steps.cost_known();
  while (!steps.Converged()) {
    const bool no_exact_step = steps.cost_known() && steps.NoExactStepCanFollow();
    const double guard = first ? kMostRise : kLastChordGuard;
    if (budget.Over() || !steps.Take(guard, settings.relative_tolerance, false)) {
      outcome->status = Status(StatusCode::kBudgetReached, "time used up");
      return no_exact_step;
    }
    const bool go_on = steps.cost_known() ? first || steps.was_cut() || steps.AreWorthIt()
                                          : steps.ratio() < kChordGuard;
    if (!steps.Converged() && !go_on && !no_exact_step) return false;
    first = false;
  }
  outcome->status = Status::Ok();
  return true;
}

}  // namespace

FrameOutcome SolveNewton(NewtonProblem& problem, const FrameSettings& settings,
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
    TakeChordSteps(problem, settings, budget, exact_step_s, &outcome);
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
