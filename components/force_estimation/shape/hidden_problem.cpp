// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/hidden_problem.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <utility>

namespace palpate::force_estimation {

namespace {

/// Size of a column that is ignored, in sigmas: beyond any force, and above rounding.
constexpr double kUnlimited = 1e8;
/// The size of the push sets the sigma of the friction, which sets the push.
constexpr int kFrictionRounds = 2;

}  // namespace

HiddenProblem::HiddenProblem(const SearchPlaces& places, const RowResponses& responses,
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
  const Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::HouseholderQRPreconditioner> svd(
      columns, Eigen::ComputeThinU);
  const Eigen::VectorXd lost = 1.0 - (1.0 + svd.singularValues().array().square()).rsqrt();
  const Eigen::MatrixXd& V = svd.matrixU();
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
  return whitening_ * responses_->To(places_->Patch(place))(Eigen::all, row_).transpose();
}

Eigen::MatrixXd HiddenProblem::Whitened(const Eigen::MatrixXd& motion_m) const {
  return whitening_ * motion_m(row_, Eigen::all);
}

PlaceFit HiddenProblem::Fit(const Eigen::Ref<const Eigen::MatrixX3d>& columns,
                            const Eigen::Vector3d& normal, double friction) const {
  const Eigen::VectorXd push = -columns * normal;
  const double push_push = push.squaredNorm();
  const double push_rest = push.dot(residual_);
  if (!(push_push > 0.0) || !(push_rest > 0.0)) return {};
  PlaceFit fit{.force_N = push_rest / push_push,
               .tangential_N = Eigen::Vector3d::Zero(),
               .gain = push_rest * push_rest / push_push,
               .evidence = push_rest * push_rest / push_push};
  if (friction <= 0.0) return fit;
  const Eigen::Vector3d first = normal.unitOrthogonal();
  const Eigen::Matrix<double, 3, 2> tangents =
      (Eigen::Matrix<double, 3, 2>() << first, normal.cross(first)).finished();
  const Eigen::MatrixX2d slide = columns * tangents;
  const Eigen::Matrix2d slide_slide = slide.transpose() * slide;
  const Eigen::Vector2d slide_push = slide.transpose() * push;
  const Eigen::Vector2d slide_rest = slide.transpose() * residual_;
  for (int round = 0; round < kFrictionRounds; ++round) {
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
