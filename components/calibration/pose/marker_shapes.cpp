// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/pose/marker_shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/linalg/qr.hpp"

namespace palpate::calibration {

namespace {

using Eigen::Index;

Index TermCount(Index cables) { return (cables + 1) * (cables + 2) / 2; }

/// 1, t_i, t_i t_j for j <= i.
Eigen::VectorXd Monomials(const Eigen::VectorXd& t) {
  Eigen::VectorXd terms(TermCount(t.size()));
  terms[0] = 1.0;
  terms.segment(1, t.size()) = t;
  Index next = 1 + t.size();
  for (Index i = 0; i < t.size(); ++i) {
    for (Index j = 0; j <= i; ++j) terms[next++] = t[i] * t[j];
  }
  return terms;
}

/// d Monomials / d t [terms x a].
Eigen::MatrixXd MonomialGradients(const Eigen::VectorXd& t) {
  Eigen::MatrixXd gradients = Eigen::MatrixXd::Zero(TermCount(t.size()), t.size());
  gradients.middleRows(1, t.size()).setIdentity();
  Index next = 1 + t.size();
  for (Index i = 0; i < t.size(); ++i) {
    for (Index j = 0; j <= i; ++j, ++next) {
      gradients(next, i) += t[j];
      gradients(next, j) += t[i];
    }
  }
  return gradients;
}

/// Digits of `index` >= 1 mirrored about the point: a low-discrepancy sequence in 0 to 1.
double RadicalInverse(int index, int base) {
  double value = 0.0;
  for (double digit = 1.0 / base; index > 0; index /= base, digit /= base) {
    value += digit * (index % base);
  }
  return value;
}

}  // namespace

MarkerShapes::MarkerShapes(const Eigen::MatrixXd& tensions_N, const Eigen::MatrixXd& positions_m,
                           const Eigen::VectorXd& most_tension_N)
    : most_tension_N_(most_tension_N) {
  const Index samples = tensions_N.cols();
  PALPATE_CHECK(samples == positions_m.cols() && samples >= TermCount(most_tension_N.size()),
                samples, positions_m.cols());
  Eigen::MatrixXd terms(samples, TermCount(most_tension_N.size()));
  for (Index s = 0; s < samples; ++s) {
    terms.row(s) = Monomials(tensions_N.col(s).cwiseQuotient(most_tension_N_)).transpose();
  }
  coefficients_ = linalg::LeastSquares(terms, Eigen::MatrixXd(positions_m.transpose())).transpose();
  const Eigen::MatrixXd missed_m = positions_m - coefficients_ * terms.transpose();
  error_m_ = std::sqrt(3.0 * missed_m.squaredNorm() / static_cast<double>(missed_m.size()));
  MeasureDistances(positions_m);
}

void MarkerShapes::MeasureDistances(const Eigen::MatrixXd& positions_m) {
  const Index markers = positions_m.rows() / 3;
  mean_m_ = positions_m.rowwise().mean().reshaped(3, markers);
  shortest_m_ = Eigen::MatrixXd::Constant(markers, markers, std::numeric_limits<double>::max());
  longest_m_ = Eigen::MatrixXd::Zero(markers, markers);
  for (const auto& shape : positions_m.colwise()) {
    const Eigen::Matrix3Xd points_m = shape.reshaped(3, markers);
    reach_m_ = std::max(reach_m_, (points_m - mean_m_).colwise().norm().maxCoeff());
    for (Index i = 0; i < markers; ++i) {
      for (Index j = 0; j < markers; ++j) {
        const double distance_m = (points_m.col(i) - points_m.col(j)).norm();
        shortest_m_(i, j) = std::min(shortest_m_(i, j), distance_m);
        longest_m_(i, j) = std::max(longest_m_(i, j), distance_m);
      }
    }
  }
}

Eigen::Matrix3Xd MarkerShapes::Positions_m(const Eigen::VectorXd& tension_N) const {
  const Eigen::VectorXd all_m = coefficients_ * Monomials(tension_N.cwiseQuotient(most_tension_N_));
  return all_m.reshaped(3, MarkerCount());
}

Eigen::MatrixXd MarkerShapes::Derivative(const Eigen::VectorXd& tension_N) const {
  return coefficients_ * MonomialGradients(tension_N.cwiseQuotient(most_tension_N_)) *
         most_tension_N_.cwiseInverse().asDiagonal();
}

SolvedShapes SolveMarkerShapes(robot::RobotModel& model, const Eigen::VectorXd& most_tension_N) {
  constexpr std::array<int, 16> kPrimes = {2,  3,  5,  7,  11, 13, 17, 19,
                                           23, 29, 31, 37, 41, 43, 47, 53};
  const Index cables = model.ActuatorCount();
  PALPATE_CHECK(most_tension_N.size() == cables && (most_tension_N.array() > 0.0).all(),
                most_tension_N.transpose());
  PALPATE_CHECK(cables <= static_cast<Index>(kPrimes.size()), cables);
  const Index samples = 3 * TermCount(cables);
  const auto& markers = model.body().markers;
  Eigen::MatrixXd tensions_N(cables, samples);
  Eigen::MatrixXd positions_m(static_cast<Index>(3 * markers.size()), samples);
  SolvedShapes solved;
  fem::StaticState state = model.RestState();
  for (Index s = 0; s < samples; ++s) {
    std::vector<robot::ActuatorCommand> commands;
    for (Index c = 0; c < cables; ++c) {
      tensions_N(c, s) = most_tension_N[c] * RadicalInverse(static_cast<int>(s), kPrimes[At(c)]);
      commands.push_back({robot::ActuatorCommand::Kind::kTension, tensions_N(c, s)});
    }
    solved.status = model.Solve(commands, {}, &state).status;
    if (!solved.status.ok()) return solved;
    for (size_t m = 0; m < markers.size(); ++m) {
      positions_m.col(s).segment<3>(static_cast<Index>(3 * m)) =
          markers[m].point.weights.Position(state.x_m);
    }
  }
  solved.shapes = MarkerShapes(tensions_N, positions_m, most_tension_N);
  return solved;
}

}  // namespace palpate::calibration
