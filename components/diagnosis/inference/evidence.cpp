// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/evidence.hpp"

#include <vector>

#include "libs/core/index.hpp"
#include "libs/linalg/cholesky.hpp"

namespace palpate::diagnosis {

Posterior Infer(const Information& data, const GaussianPrior& prior) {
  std::vector<Eigen::Index> free;
  for (Eigen::Index p = 0; p < prior.sigma.size(); ++p) {
    if (prior.sigma[p] > 0.0) free.push_back(p);
  }
  std::vector<Eigen::Index> fixed_away;
  for (Eigen::Index p = 0; p < prior.mean.size(); ++p) {
    if (prior.mean[p] != 0.0) fixed_away.push_back(p);
  }
  double c = data.c;
  Eigen::VectorXd b = data.b;
  for (const Eigen::Index p : fixed_away) {
    const double before = b[p];
    b -= prior.mean[p] * data.H.col(p);
    c -= prior.mean[p] * (before + b[p]);
  }
  const Eigen::VectorXd sigma = prior.sigma(free);
  Eigen::MatrixXd A = sigma.asDiagonal() * data.H(free, free) * sigma.asDiagonal();
  A.diagonal().array() += 1.0;
  const Eigen::VectorXd g = sigma.cwiseProduct(b(free));
  const linalg::Cholesky factor(A);
  const Eigen::VectorXd steps = factor.Solve(g);
  Posterior posterior;
  posterior.misfit = c - g.dot(steps);
  posterior.ln_evidence = -0.5 * posterior.misfit - 0.5 * factor.LnDeterminant();
  posterior.mean = prior.mean;
  for (std::size_t k = 0; k < free.size(); ++k) {
    const auto i = ToIndex(k);
    posterior.mean[free[k]] += sigma[i] * steps[i];
  }
  posterior.covariance = Eigen::MatrixXd::Zero(prior.sigma.size(), prior.sigma.size());
  const Eigen::MatrixXd inverse = factor.Inverse();
  posterior.covariance(free, free) = sigma.asDiagonal() * inverse * sigma.asDiagonal();
  return posterior;
}

}  // namespace palpate::diagnosis
