// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/start_shapes.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/index.hpp"
#include "libs/linalg/cholesky.hpp"

namespace palpate::diagnosis {

bool StartShapes::Begin(std::size_t s, const std::vector<SimulatedSample>& samples,
                        HeldShape* shape) const {
  if (shape->state.x_m.size() > 0) {
    if (moved_.empty()) return false;
    const Eigen::VectorXd moved_by_m = MovedBy_m(s);
    const auto nodes_m = shape->state.x_m.reshaped(3, shape->state.x_m.size() / 3);
    const double diagonal_m = (nodes_m.rowwise().maxCoeff() - nodes_m.rowwise().minCoeff()).norm();
    if (moved_by_m.cwiseAbs().maxCoeff() < tuning_.least * diagonal_m) return false;
    shape->state.x_m += moved_by_m;
    return true;
  }
  if (balanced_.empty()) return false;
  const std::size_t nearest =
      *std::min_element(balanced_.rbegin(), balanced_.rend(), [&](std::size_t a, std::size_t b) {
        return distance_.ToBegin(a, s) < distance_.ToBegin(b, s);
      });
  shape->state = samples[nearest].middle.state;
  shape->obstacle_force_N = samples[nearest].middle.obstacle_force_N;
  return true;
}

void StartShapes::Learn(std::size_t s, const Eigen::VectorXd& began_m, const HeldShape& shape) {
  balanced_.push_back(s);
  if (began_m.size() == 0) return;
  moved_.push_back(s);
  moved_m_.emplace_back(shape.state.x_m - began_m);
}

double StartShapes::Covariance(std::size_t a, std::size_t b) const {
  const double apart = distance_.Between(a, b) / tuning_.length;
  return tuning_.alike + std::exp(-0.5 * apart * apart) + (a == b ? tuning_.own : 0.0);
}

Eigen::VectorXd StartShapes::MovedBy_m(std::size_t s) const {
  const auto count = std::ssize(moved_);
  Eigen::MatrixXd covariance(count, count);
  Eigen::VectorXd with_s(count);
  for (Eigen::Index a = 0; a < count; ++a) {
    for (Eigen::Index b = 0; b < count; ++b)
      covariance(a, b) = Covariance(moved_[At(a)], moved_[At(b)]);
    with_s[a] = Covariance(moved_[At(a)], s);
  }
  const Eigen::VectorXd weight = linalg::SolveSymmetric(covariance, with_s);
  Eigen::VectorXd moved_by_m = Eigen::VectorXd::Zero(moved_m_.front().size());
  for (Eigen::Index a = 0; a < count; ++a) moved_by_m += weight[a] * moved_m_[At(a)];
  return moved_by_m;
}

}  // namespace palpate::diagnosis
