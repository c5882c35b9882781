// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/hidden_problem.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <utility>

#include "libs/core/index.hpp"
#include "libs/linalg/svd.hpp"

namespace palpate::force_estimation {

namespace {

/// Prior sigma of an ignored column: beyond any force, and above rounding.
constexpr double kUnlimited = 1e8;

}  // namespace

HiddenProblem::HiddenProblem(const CandidateLocations& places, const ObservationJacobian& responses,
                             std::vector<int> row, const Eigen::VectorXd& scale_1_m,
                             const Eigen::VectorXd& residual_m)
    : places_(&places),
      responses_(&responses),
      row_(std::move(row)),
      whitening_(scale_1_m.asDiagonal()),
      residual_(scale_1_m.cwiseProduct(residual_m)) {}

/// The noise becomes I + B B' = V (1 + s^2) V' + the rest; multiplies by its root's inverse.
void HiddenProblem::Absorb(const Eigen::MatrixXd& columns) {
  if (columns.cols() == 0) return;
  const linalg::LeftSvd svd = linalg::DecomposeTall(columns);
  const Eigen::VectorXd lost = 1.0 - (1.0 + svd.values.array().square()).rsqrt();
  const Eigen::MatrixXd& V = svd.U;
  residual_ -= V * lost.cwiseProduct(V.transpose() * residual_);
  const Eigen::MatrixXd along = lost.asDiagonal() * (V.transpose() * whitening_);
  whitening_.noalias() -= V * along;
}

void HiddenProblem::Ignore(Eigen::MatrixXd columns) {
  for (auto column : columns.colwise()) {
    const double size = column.norm();
    if (size > 0.0) column *= kUnlimited / size;
  }
  Absorb(columns);
}

Eigen::MatrixX3d HiddenProblem::Place(int place) const {
  return whitening_ * responses_->To(places_->Patch(place))(row_, Eigen::all);
}

Eigen::MatrixXd HiddenProblem::Whitened(const Eigen::MatrixXd& motion_m) const {
  return whitening_ * motion_m(row_, Eigen::all);
}

std::vector<PlaceEquations> HiddenProblem::EquationsAt(const std::vector<int>& places) const {
  const auto count = ToIndex(places.size());
  Eigen::MatrixXd motion_m(responses_->Count(), 3 * count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const int place = places[At(k)];
    motion_m.middleCols<3>(3 * k) = responses_->To(places_->Patch(place));
  }
  const Eigen::MatrixXd columns = Whitened(motion_m);
  const Eigen::VectorXd pull = columns.transpose() * residual_;
  std::vector<PlaceEquations> equations(places.size());
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto of_place = columns.middleCols<3>(3 * k);
    equations[At(k)] = {of_place.transpose() * of_place, pull.segment<3>(3 * k)};
  }
  return equations;
}

PlaceFit FitPush(const PlaceEquations& equations, const Eigen::Vector3d& normal, double friction,
                 const FitPushTuning& tuning) {
  const auto& [gram, pull] = equations;
  const Eigen::Vector3d push = -gram * normal;
  const double push_push = -normal.dot(push);
  const double push_rest = -normal.dot(pull);
  if (!(push_push > 0.0) || !(push_rest > 0.0)) return {};
  PlaceFit fit{.force_N = push_rest / push_push,
               .tangential_N = Eigen::Vector3d::Zero(),
               .gain = push_rest * push_rest / push_push,
               .evidence = push_rest * push_rest / push_push};
  if (friction <= 0.0) return fit;
  const Eigen::Vector3d first = normal.unitOrthogonal();
  const Eigen::Matrix<double, 3, 2> tangents =
      (Eigen::Matrix<double, 3, 2>() << first, normal.cross(first)).finished();
  const Eigen::Matrix2d slide_slide = tangents.transpose() * gram * tangents;
  const Eigen::Vector2d slide_push = tangents.transpose() * push;
  const Eigen::Vector2d slide_rest = tangents.transpose() * pull;
  for (int round = 0; round < tuning.friction_rounds; ++round) {
    const double variance_N2 = std::pow(friction * fit.force_N, 2);
    const Eigen::Matrix2d noise = Eigen::Matrix2d::Identity() + variance_N2 * slide_slide;
    const Eigen::Matrix2d inverse = variance_N2 * noise.inverse();
    const double stiff = push_push - slide_push.dot(inverse * slide_push);
    const double along = push_rest - slide_push.dot(inverse * slide_rest);
    if (!(stiff > 0.0) || !(along > 0.0)) return {};
    fit.force_N = along / stiff;
    fit.gain = slide_rest.dot(inverse * slide_rest) + along * along / stiff;
    fit.tangential_N = tangents * (inverse * (slide_rest - fit.force_N * slide_push));
    fit.evidence = fit.gain - std::log(noise.determinant());
  }
  return fit;
}

}  // namespace palpate::force_estimation
