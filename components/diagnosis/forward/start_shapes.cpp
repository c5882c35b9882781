// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/start_shapes.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/index.hpp"
#include "libs/linalg/cholesky.hpp"

namespace palpate::diagnosis {

namespace {

/// What was the same is the same to the last bit, so that its balance need not be sought again.
Eigen::VectorXd MovedAs(const Eigen::VectorXd& was, const Eigen::VectorXd& now,
                        const Eigen::VectorXd& value) {
  if (value == was) return now;
  return value + (now - was);
}

/// What would begin or cease to hold the body keeps its multiplier: that it does is found by
/// comparing (sample_in_parts.cpp).
Eigen::VectorXd MultipliersMovedAs(const fem::StaticState& was, const fem::StaticState& now,
                                   const Eigen::VectorXd& value_N) {
  if (was.multipliers_N.size() != value_N.size() || now.multipliers_N.size() != value_N.size())
    return value_N;
  Eigen::VectorXd moved_N = MovedAs(was.multipliers_N, now.multipliers_N, value_N);
  const auto holds = [](const Eigen::VectorXd& multipliers_N) -> Eigen::Array<bool, -1, 1> {
    return multipliers_N.array() > HeldShape::kNothing_N;
  };
  return (holds(moved_N) == holds(value_N)).all() ? moved_N : value_N;
}

}  // namespace

bool StartShapes::Begin(std::size_t s, const std::vector<SimulatedSample>& samples,
                        HeldShape* shape) const {
  fem::StaticState& state = shape->state;
  if (state.x_m.size() > 0) {
    if (moves_.empty()) return false;
    const Move* same = OfSameDrive(s);
    const Eigen::VectorXd moved_by_m = same != nullptr ? same->nodes_m : MovedBy_m(s);
    const auto nodes_m = state.x_m.reshaped(3, state.x_m.size() / 3);
    const double diagonal_m = (nodes_m.rowwise().maxCoeff() - nodes_m.rowwise().minCoeff()).norm();
    if (moved_by_m.cwiseAbs().maxCoeff() < tuning_.least * diagonal_m) return false;
    if (same != nullptr) {
      state.x_m = MovedAs(same->was.x_m, same->now.x_m, state.x_m);
      state.multipliers_N = MultipliersMovedAs(same->was, same->now, state.multipliers_N);
    } else {
      state.x_m += moved_by_m;
    }
    return true;
  }
  if (balanced_.empty()) return false;
  const std::size_t nearest =
      *std::min_element(balanced_.rbegin(), balanced_.rend(), [&](std::size_t a, std::size_t b) {
        return distance_.ToBegin(a, s) < distance_.ToBegin(b, s);
      });
  if (distance_.FromUndeformed(s) < distance_.ToBegin(nearest, s)) return false;
  shape->state = samples[nearest].middle.state;
  shape->obstacle_force_N = samples[nearest].middle.obstacle_force_N;
  return true;
}

void StartShapes::Learn(std::size_t s, const HeldShape& was, const HeldShape& now) {
  balanced_.push_back(s);
  if (was.state.x_m.size() == 0) return;
  moves_.push_back({s, was.state, now.state, now.state.x_m - was.state.x_m});
}

const StartShapes::Move* StartShapes::OfSameDrive(std::size_t s) const {
  const auto nearest =
      std::min_element(moves_.rbegin(), moves_.rend(), [&](const Move& a, const Move& b) {
        return distance_.Between(a.sample, s) < distance_.Between(b.sample, s);
      });
  return distance_.Between(nearest->sample, s) < tuning_.same ? &*nearest : nullptr;
}

double StartShapes::Covariance(std::size_t a, std::size_t b) const {
  const double apart = distance_.Between(a, b) / tuning_.length;
  return tuning_.alike + std::exp(-0.5 * apart * apart) + (a == b ? tuning_.own : 0.0);
}

Eigen::VectorXd StartShapes::MovedBy_m(std::size_t s) const {
  const auto count = std::ssize(moves_);
  Eigen::MatrixXd covariance(count, count);
  Eigen::VectorXd with_s(count);
  for (Eigen::Index a = 0; a < count; ++a) {
    for (Eigen::Index b = 0; b < count; ++b)
      covariance(a, b) = Covariance(moves_[At(a)].sample, moves_[At(b)].sample);
    with_s[a] = Covariance(moves_[At(a)].sample, s);
  }
  const Eigen::VectorXd weight = linalg::SolveSymmetric(covariance, with_s);
  Eigen::VectorXd moved_by_m = Eigen::VectorXd::Zero(moves_.front().nodes_m.size());
  for (Eigen::Index a = 0; a < count; ++a) moved_by_m += weight[a] * moves_[At(a)].nodes_m;
  return moved_by_m;
}

}  // namespace palpate::diagnosis
