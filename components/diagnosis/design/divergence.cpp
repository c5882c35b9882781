// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/design/divergence.hpp"

namespace palpate::diagnosis {

namespace {

Eigen::MatrixXd CovarianceOf(const Eigen::MatrixXd& J, const Posterior& posterior) {
  Eigen::MatrixXd covariance = J * posterior.covariance * J.transpose();
  covariance.diagonal().array() += 1.0;
  return covariance;
}

}  // namespace

Prediction::Prediction(const Eigen::MatrixXd& J, const Posterior& posterior)
    : mean(J * posterior.mean), covariance(CovarianceOf(J, posterior)), factor(covariance) {}

double ExpectedLnBayesFactor(const Prediction& a, const Prediction& b) {
  const Eigen::VectorXd apart = a.mean - b.mean;
  return 0.5 *
         (b.factor.Solve(a.covariance).trace() - static_cast<double>(apart.size()) +
          apart.dot(b.factor.Solve(apart)) + b.factor.LnDeterminant() - a.factor.LnDeterminant());
}

double InformationGain(const Eigen::MatrixXd& J, const Posterior& posterior,
                       const std::vector<Eigen::Index>& parameters, const Prediction& predicted) {
  std::vector<Eigen::Index> free;
  for (const Eigen::Index p : parameters) {
    if (posterior.covariance(p, p) > 0.0) free.push_back(p);
  }
  if (free.empty()) return 0.0;
  const Eigen::MatrixXd before = posterior.covariance(free, free);
  const Eigen::MatrixXd seen = J * posterior.covariance(Eigen::all, free);
  const Eigen::MatrixXd after = before - seen.transpose() * predicted.factor.Solve(seen);
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
