// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>

#include "components/force_estimation/fit/force_fitter.hpp"

namespace palpate::force_estimation {

namespace {

using Kind = robot::CableCommand::Kind;

}  // namespace

/// At the state that the linearisation and the QP were updated at last.
double ForceFitter::Error(const ModelState& state) const {
  return std::max(BalanceError(state), LargestChange(state));
}

/// At the state that the linearisation was updated at last.
double ForceFitter::BalanceError(const ModelState& state) const {
  const fem::Linearisation& linearisation = model_.linearisation();
  const double residual_N = linearisation.residual_N().norm();
  double error = CableError(state);
  if (residual_N > fem::RoundingForce_N(linearisation, state.x_m)) {
    const double scale_N = std::max(
        {linearisation.internal_force_norm_N(), weight_N_.norm(), state.lambda_f_N.norm(), 1e-9});
    error = std::max(error, residual_N / scale_N);
  }
  return error;
}

/// Length by which a taut cable misses its displacement, or a slack one is too long, over its rest
/// length.
double ForceFitter::CableError(const ModelState& state) const {
  double error = 0.0;
  for (int c = 0; c < model_.CableCount(); ++c) {
    const robot::CableCommand& command = (*frame_.cables)[static_cast<size_t>(c)];
    if (command.kind != Kind::kDisplacement) continue;
    const double missing_m = command.value - model_.cable(c).Displacement_m(state.x_m);
    const bool taut = state.lambda_a_N[c] > 0.0;
    error =
        std::max(error, (taut ? std::abs(missing_m) : missing_m) / model_.cable(c).rest_length_m());
  }
  return error;
}

/// Largest change of a force that the QP asks for, relative where forces are above 1 N.
double ForceFitter::LargestChange(const ModelState& state) const {
  const double change = std::max((new_lambda_f_ - state.lambda_f_N).lpNorm<Eigen::Infinity>(),
                                 (new_lambda_a_ - state.lambda_a_N).lpNorm<Eigen::Infinity>());
  return change / std::max(1.0, new_lambda_f_.lpNorm<Eigen::Infinity>());
}

/// Of the step that the QP asks for, where that is longer than a step may be.
double ForceFitter::StepShare(const ModelState& state) const {
  const double change_N = (new_lambda_f_ - state.lambda_f_N).lpNorm<Eigen::Infinity>();
  return longest_step_N_ > 0.0 && change_N > longest_step_N_ ? longest_step_N_ / change_N : 1.0;
}

/// The trial goes on by what the last steps with this factor tell of its error.
void ForceFitter::Accelerate() {
  const ModelState& state = *frame_.state;
  step_.x_m = trial_.x_m - state.x_m;
  step_.lambda_a_N = trial_.lambda_a_N - state.lambda_a_N;
  step_.lambda_f_N = trial_.lambda_f_N - state.lambda_f_N;
  from_.x_m = state.x_m;
  from_.lambda_a_N = state.lambda_a_N;
  from_.lambda_f_N = state.lambda_f_N;
  if (!secants_.Improve(from_, step_, &correction_)) return;
  trial_.x_m += correction_.x_m;
  trial_.lambda_a_N += correction_.lambda_a_N;
  trial_.lambda_f_N += correction_.lambda_f_N;
}

}  // namespace palpate::force_estimation
