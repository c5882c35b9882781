// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/solved_state.hpp"
#include "libs/core/index.hpp"

namespace palpate::calibration {

double ExtentOf(const Eigen::VectorXd& x_m) {
  const auto points = x_m.reshaped(3, x_m.size() / 3);
  return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).maxCoeff();
}

void SolvedState::Keep(const fem::StaticState& state, const Eigen::VectorXd& variables,
                       const std::vector<Eigen::Index>& column, const std::vector<double>& factor,
                       const robot::SensitivitySolver& sensitivity) {
  MoveBase(state, variables);
  column_ = column;
  const auto columns = ToIndex(column.size());
  motion_m_.resize(x_m_.size(), columns);
  multiplier_rise_N_ = sensitivity.tension_N();
  Eigen::VectorXd motion_m;
  for (Eigen::Index p = 0; p < columns; ++p) {
    sensitivity.NodalMotion(static_cast<int>(p), &motion_m);
    motion_m_.col(p) = factor[At(p)] * motion_m;
    multiplier_rise_N_.col(p) *= factor[At(p)];
  }
}

void SolvedState::MoveBase(const fem::StaticState& state, const Eigen::VectorXd& variables) {
  x_m_ = state.x_m;
  multipliers_N_ = state.multipliers_N;
  variables_ = variables;
}

Eigen::VectorXd SolvedState::ChangeTo(const Eigen::VectorXd& variables) const {
  Eigen::VectorXd change(motion_m_.cols());
  for (std::size_t p = 0; p < column_.size(); ++p) {
    change[ToIndex(p)] = variables[column_[p]] - variables_[column_[p]];
  }
  return change;
}

SolvedState::Move SolvedState::MoveTo(const Eigen::VectorXd& variables,
                                      fem::StaticState* state) const {
  if (x_m_.size() == 0) return Move::kUnknown;
  const Eigen::VectorXd change = ChangeTo(variables);
  const Eigen::VectorXd motion_m = motion_m_ * change;
  const double furthest = motion_m.lpNorm<Eigen::Infinity>() / ExtentOf(x_m_);
  if (!(furthest < kSolvedStateTuning.small_move)) return Move::kUnknown;
  Extrapolate(variables, state);
  return furthest < kSolvedStateTuning.tiny_move ? Move::kTiny : Move::kSmall;
}

/// Multipliers stay at 0 or above, as in an equilibrium.
void SolvedState::Extrapolate(const Eigen::VectorXd& variables, fem::StaticState* state) const {
  const Eigen::VectorXd change = ChangeTo(variables);
  state->x_m = x_m_ + motion_m_ * change;
  state->multipliers_N = (multipliers_N_ + multiplier_rise_N_ * change).cwiseMax(0.0);
}

SolvedState::Place SolvedState::PlaceOf(const fem::InterpolationWeights& point,
                                        const Eigen::VectorXd& variables) const {
  Place place;
  place.motion_m.setZero(3, motion_m_.cols());
  for (std::size_t k = 0; k < point.nodes.size(); ++k) {
    place.motion_m += point.weights[k] * motion_m_.middleRows<3>(3 * point.nodes[k]);
  }
  place.position_m = point.Position(x_m_) + place.motion_m * ChangeTo(variables);
  return place;
}

}  // namespace palpate::calibration
