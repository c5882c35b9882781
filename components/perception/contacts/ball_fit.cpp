// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/contacts/ball_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "libs/linalg/qr.hpp"

namespace palpate::perception {

namespace {

/// |p|^2 = 2 c p + k, linear in c and k; unknowns (c, R).
std::optional<Eigen::Vector4d> FitAlgebraically(const Eigen::Matrix3Xd& points_m) {
  Eigen::MatrixXd rows(points_m.cols(), 4);
  rows << 2.0 * points_m.transpose(), Eigen::VectorXd::Ones(points_m.cols());
  const Eigen::VectorXd squares = points_m.colwise().squaredNorm();
  const Eigen::Vector4d fit = linalg::LeastSquares(rows, squares);
  const double radius_m2 = fit[3] + fit.head<3>().squaredNorm();
  if (!(radius_m2 > 0.0)) return std::nullopt;
  return Eigen::Vector4d(fit[0], fit[1], fit[2], std::sqrt(radius_m2));
}

}  // namespace

std::optional<Ball> FitBall(const Eigen::Matrix3Xd& points_m, double sigma_m,
                            const BallFitTuning& tuning) {
  const Eigen::Index count = points_m.cols();
  if (count < tuning.fewest_points) return std::nullopt;
  const Eigen::Vector3d middle_m = points_m.rowwise().mean();
  const Eigen::Matrix3Xd off_m = points_m.colwise() - middle_m;
  auto fit = FitAlgebraically(off_m);
  if (!fit) return std::nullopt;
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
  double sum_squares_m2 = 0.0;
  for (int round = 0; round < tuning.rounds; ++round) {
    const Eigen::Matrix3Xd from_center_m = off_m.colwise() - fit->head<3>();
    const Eigen::RowVectorXd distance_m = from_center_m.colwise().norm().cwiseMax(1e-9);
    Eigen::Matrix4Xd gradient(4, count);
    gradient << from_center_m.array().rowwise() / distance_m.array(),
        Eigen::RowVectorXd::Ones(count);
    const Eigen::RowVectorXd residual_m = distance_m.array() - (*fit)[3];
    sum_squares_m2 = residual_m.squaredNorm();
    information = gradient * gradient.transpose();
    *fit += Eigen::LDLT<Eigen::Matrix4d>(information).solve(gradient * residual_m.transpose());
    if (!fit->allFinite() || !((*fit)[3] > 0.0) || (*fit)[3] > tuning.largest_radius_m) {
      return std::nullopt;
    }
  }
  Ball ball;
  ball.center_m = middle_m + fit->head<3>();
  ball.radius_m = (*fit)[3];
  ball.residual_m = std::sqrt(sum_squares_m2 / static_cast<double>(count));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(
      off_m * off_m.transpose() / static_cast<double>(count), Eigen::EigenvaluesOnly);
  ball.covered_m = std::sqrt(std::max(0.0, axes.eigenvalues()[1]));
  const double variance_m2 =
      std::max(sigma_m, ball.residual_m) * std::max(sigma_m, ball.residual_m);
  ball.covariance_m2 =
      variance_m2 * Eigen::LDLT<Eigen::Matrix4d>(information).solve(Eigen::Matrix4d::Identity());
  const bool from_outside = ball.center_m.dot(ball.center_m - middle_m) > 0.0;
  if (!from_outside || !ball.covariance_m2.allFinite()) return std::nullopt;
  return ball;
}

}  // namespace palpate::perception
