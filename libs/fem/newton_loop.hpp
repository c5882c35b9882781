// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/core/status.hpp"
#include "libs/fem/time_budget.hpp"

namespace palpate::fem {

struct FrameSettings {
  /// A frame has converged when its error (NewtonProblem::TrialError) is no larger.
  double relative_tolerance = 1e-8;
  int max_exact_steps = 40;
  /// Begin with the factor of an earlier frame, and go on with it as long as each step brings the
  /// error below 0.3 of what it was.
  bool keep_factor = false;
  /// What an exact step costs, on the budget's clock; 0: not known before one was made.
  double exact_step_cost_s = 0.0;
};

/// What came of one frame.
struct FrameOutcome {
  /// kOk: converged. kBudgetReached: the last state is sound and nearer, but not converged. All
  /// else (kNotConverged, kInverted, kNotPositiveDefinite, ...): diverged, the last state is of no
  /// use.
  Status status;
  int exact_steps = 0;  ///< each with its linearisation
  int chord_steps = 0;  ///< accepted ones
  double error = 0.0;   ///< relative, of the last state

  bool converged() const { return status.ok(); }
  bool diverged() const { return !converged() && status.code() != StatusCode::kBudgetReached; }
};

/// What the frame loop moves: a state, and a step from it.
class NewtonProblem {
 public:
  virtual ~NewtonProblem() = default;

  /// Linearises at the state and computes the step. On failure there is none.
  virtual Status PrepareExactStep() = 0;
  /// Computes the step for the residual at the state, with the factor that is there.
  virtual Status PrepareChordStep() = 0;
  /// With FrameSettings::keep_factor: computes the step from the state with the factor of an
  /// earlier frame. Not ok: there is none.
  virtual Status PrepareFrozenFactorStep() { return {}; }
  /// Error at the state after a successful PrepareFrozenFactorStep, as TrialError.
  virtual double StartError() const { return 0.0; }
  /// Evaluates the residual where `length` times the step leads. kInverted: an element would turn
  /// inside out there. The state stays. `last`: no time is left for a step from there, so that an
  /// error above the tolerance need only be bounded from below.
  virtual Status Try(double length, bool last) = 0;
  /// Error where the last successful Try led, relative, comparable with a tolerance.
  virtual double TrialError() const = 0;
  /// Whether the last Try went less far than the step leads, on purpose: its error says little.
  virtual bool StepWasCut() const { return false; }
  /// The state becomes what the last successful Try evaluated.
  virtual void AcceptTrial() = 0;
};

/// The loop of one frame: an exact step (halved while it would invert an element), then a chord
/// step, kept only if the error fell below 0.3 of what it was, then the next exact step, until the
/// error is within the tolerance, or the steps or the time are used up. An exact step is not begun
/// where one as long as the last would overrun the budget; one is always made. Diverged: no step,
/// an error that is no number, or one that has not fallen for several exact steps. Newton's first
/// step may raise it: bending bodies pass through stretched states. Where the cost of an exact step
/// is known beforehand, chord steps go on as long as they are expected to reach the tolerance for
/// less, and the first with a kept factor, which is no worse than Newton's, may raise the error,
/// too. Where a kept factor gives a step and the budget has no room for an exact one of a known
/// cost, chord steps alone go on as long as each gains.
FrameOutcome SolveNewton(NewtonProblem& problem, const FrameSettings& settings,
                         const TimeBudget& budget);

}  // namespace palpate::fem
