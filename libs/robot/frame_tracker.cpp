// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/frame_tracker.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"

namespace palpate::robot {

FrameTracker::FrameTracker(RobotModel& model, const fem::FrameSettings& settings)
    : model_(model), settings_(settings), step_(model.linearisation()) {}

void FrameTracker::Start(const fem::StaticState& state) {
  state_ = last_good_ = state;
  trial_x_m_ = state.x_m;
  trial_multipliers_N_ = state.multipliers_N;
}

const fem::FrameOutcome& FrameTracker::Follow(const std::vector<ActuatorCommand>& cables,
                                              const Eigen::VectorXd& force_N,
                                              const fem::TimeBudget& budget) {
  PALPATE_CHECK(state_.x_m.size() > 0 && force_N.size() == state_.x_m.size(), force_N.size());
  PALPATE_CHECK(static_cast<int>(cables.size()) == model_.ActuatorCount(), cables.size());
  SetLoads(cables, force_N);
  fem::EquilibriumStep::ImposeMultipliers(state_.loads, &state_.multipliers_N);
  outcome_ = fem::SolveNewton(*this, settings_, budget);
  if (outcome_.converged() && model_.ActuatorCount() > 0) {
    // A cable at its largest tension balances the body, yet not with the displacement asked for.
    outcome_.status = fem::CheckLargestMultipliers(
        model_.linearisation(), state_.loads, state_.x_m, state_.multipliers_N,
        settings_.relative_tolerance * model_.actuator_rest_m().cwiseAbs().maxCoeff());
  }
  if (outcome_.converged()) last_good_ = state_;
  if (outcome_.diverged()) state_ = last_good_;
  return outcome_;
}

void FrameTracker::SetLoads(const std::vector<ActuatorCommand>& cables,
                            const Eigen::VectorXd& force_N) {
  state_.loads.external_force_N = force_N;
  model_.AddWeight(state_.loads.external_force_N);
  for (int c = 0; c < model_.ActuatorCount(); ++c) {
    state_.loads.commands[At(c)] = model_.ToConstraint(c, cables[At(c)]);
  }
}

Status FrameTracker::PrepareExactStep() {
  return step_.Compute(state_.loads, state_.x_m, state_.multipliers_N, /*allow_shift=*/false);
}

Status FrameTracker::PrepareChordStep() {
  return step_.ComputeChord(state_.loads, state_.x_m, state_.multipliers_N);
}

Status FrameTracker::Try(double length, bool /*last*/) {
  step_.Apply(length, state_.x_m, state_.multipliers_N, &trial_x_m_, &trial_multipliers_N_);
  Status status = model_.linearisation().UpdateResidual(trial_x_m_, trial_multipliers_N_,
                                                        state_.loads.external_force_N);
  if (status.ok()) trial_error_ = Error();
  return status;
}

void FrameTracker::AcceptTrial() {
  state_.x_m.swap(trial_x_m_);
  state_.multipliers_N.swap(trial_multipliers_N_);
}

double FrameTracker::Error() const {
  const fem::Linearisation& linearisation = model_.linearisation();
  const double residual_N = linearisation.residual_N().norm();
  double error = 0.0;
  if (residual_N > fem::RoundingForce_N(linearisation, trial_x_m_)) {
    error = residual_N / fem::ForceScale_N(linearisation, state_.loads, trial_multipliers_N_);
  }
  if (model_.ActuatorCount() == 0) return error;
  const double missed_m =
      fem::ConstraintError_m(linearisation, state_.loads, trial_x_m_, trial_multipliers_N_);
  return std::max(error, missed_m / model_.actuator_rest_m().cwiseAbs().minCoeff());
}

}  // namespace palpate::robot
