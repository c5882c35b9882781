// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/design/divergence.hpp"

#include "libs/linalg/cholesky.hpp"

namespace palpate::diagnosis {

namespace {

Eigen::MatrixXd CovarianceOf(const Eigen::MatrixXd& J, const Posterior& posterior) {
  Eigen::MatrixXd covariance = J * posterior.covariance * J.transpose();
  covariance.diagonal().array() += 1.0;
  return covariance;
}

}  // namespace

double ExpectedLnBayesFactor(const Eigen::MatrixXd& J, const Posterior& a, const Posterior& b) {
  const Eigen::MatrixXd covariance_a = CovarianceOf(J, a);
  const linalg::Cholesky factor_a(covariance_a);
  const linalg::Cholesky factor_b(CovarianceOf(J, b));
  const Eigen::VectorXd apart = J * (a.mean - b.mean);
  return 0.5 *
         (factor_b.Solve(covariance_a).trace() - static_cast<double>(J.rows()) +
          apart.dot(factor_b.Solve(apart)) + factor_b.LnDeterminant() - factor_a.LnDeterminant());
}

double InformationGain(const Eigen::MatrixXd& J, const Posterior& posterior,
                       const std::vector<Eigen::Index>& parameters) {
  std::vector<Eigen::Index> free;
  for (const Eigen::Index p : parameters) {
    if (posterior.covariance(p, p) > 0.0) free.push_back(p);
  }
  if (free.empty()) return 0.0;
  const Eigen::MatrixXd before = posterior.covariance(free, free);
  const Eigen::MatrixXd seen = J * posterior.covariance(Eigen::all, free);
  const linalg::Cholesky factor(CovarianceOf(J, posterior));
  const Eigen::MatrixXd after = before - seen.transpose() * factor.Solve(seen);
  // Of unit variances, lest those in metres and in newtons spoil each other's digits.
  constexpr double kRounding = 1e-9;
  const Eigen::VectorXd scale = before.diagonal().cwiseSqrt().cwiseInverse();
  const auto ln_volume = [&](const Eigen::MatrixXd& covariance) {
    Eigen::MatrixXd scaled = scale.asDiagonal() * covariance * scale.asDiagonal();
    scaled.diagonal().array() += kRounding;
    return 0.5 * linalg::Cholesky(scaled).LnDeterminant();
  };
  return ln_volume(before) - ln_volume(after);
}

}  // namespace palpate::diagnosis
