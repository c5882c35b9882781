// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/solved_state.hpp"

namespace palpate::calibration {

namespace {

/// Of the body's extent. What first order leaves out of a tiny move is its square.
constexpr double kSmallMove = 0.05;
constexpr double kTinyMove = 1e-6;

double ExtentOf(const Eigen::VectorXd& x_m) {
  const auto points = x_m.reshaped(3, x_m.size() / 3);
  return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).maxCoeff();
}

}  // namespace

void SolvedState::Keep(const Eigen::VectorXd& x_m, const Eigen::VectorXd& variables,
                       const std::vector<Eigen::Index>& column, const std::vector<double>& factor,
                       const robot::SensitivitySolver& sensitivity) {
  x_m_ = x_m;
  variables_ = variables;
  column_ = column;
  motion_m_.resize(x_m.size(), static_cast<Eigen::Index>(column.size()));
  Eigen::VectorXd motion_m;
  for (std::size_t p = 0; p < column.size(); ++p) {
    sensitivity.NodalMotion(static_cast<int>(p), &motion_m);
    motion_m_.col(static_cast<Eigen::Index>(p)) = factor[p] * motion_m;
  }
}

SolvedState::Move SolvedState::MoveTo(const Eigen::VectorXd& variables,
                                      Eigen::VectorXd* x_m) const {
  if (x_m_.size() == 0) return Move::kUnknown;
  Eigen::VectorXd change(motion_m_.cols());
  for (std::size_t p = 0; p < column_.size(); ++p) {
    change[static_cast<Eigen::Index>(p)] = variables[column_[p]] - variables_[column_[p]];
  }
  const Eigen::VectorXd motion_m = motion_m_ * change;
  const double furthest = motion_m.lpNorm<Eigen::Infinity>() / ExtentOf(x_m_);
  if (!(furthest < kSmallMove)) return Move::kUnknown;
  *x_m = x_m_ + motion_m;
  return furthest < kTinyMove ? Move::kTiny : Move::kSmall;
}

Eigen::Matrix3Xd SolvedState::PointMotion(const fem::NodeWeights& point) const {
  Eigen::Matrix3Xd motion_m = Eigen::Matrix3Xd::Zero(3, motion_m_.cols());
  for (std::size_t k = 0; k < point.nodes.size(); ++k) {
    motion_m += point.weights[k] * motion_m_.middleRows<3>(3 * point.nodes[k]);
  }
  return motion_m;
}

}  // namespace palpate::calibration
