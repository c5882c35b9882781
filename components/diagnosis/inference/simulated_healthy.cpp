// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/simulated_healthy.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "libs/core/index.hpp"
#include "libs/linalg/product.hpp"

namespace palpate::diagnosis {

namespace {

/// Whether a parameter with a tolerance, or one of a fault that has none, is as large as faults
/// are.
bool IsBeyondTolerances(const HypothesisSet& hypotheses, int fault, const Eigen::VectorXd& mean,
                        double least_tolerances) {
  bool has_tolerance = false;
  for (Eigen::Index p = 0; p < mean.size(); ++p) {
    const double tolerance = hypotheses.ToleranceOf(fault, static_cast<int>(p));
    if (tolerance <= 0.0) continue;
    has_tolerance = true;
    if (std::abs(mean[p]) >= least_tolerances * tolerance) return true;
  }
  return !has_tolerance;
}

/// A robot within its tolerances; of what has one sign only, with that sign.
Eigen::VectorXd DrawHealthy(const HypothesisSet& hypotheses, const GaussianPrior& prior,
                            std::mt19937_64* random) {
  std::normal_distribution<double> normal;
  Eigen::VectorXd z = Eigen::VectorXd::Zero(prior.sigma.size());
  for (int k = 0; k < hypotheses.size(); ++k) {
    for (Eigen::Index p = 0; p < hypotheses.count(k); ++p) {
      const Eigen::Index column = hypotheses.first(k) + p;
      z[column] = prior.sigma[column] * normal(*random);
      if (hypotheses.model(k).parameters()[At(p)].least == 0.0) z[column] = std::abs(z[column]);
    }
  }
  return z;
}

}  // namespace

SimulatedHealthy SimulateHealthyRobots(const HypothesisSet& hypotheses,
                                       const LinearComparison& comparison, const Fit& null_model,
                                       double clear_evidence, double least_tolerances, int draws,
                                       std::uint64_t seed) {
  constexpr double kQuantile = 0.98;
  const Eigen::MatrixXd& J = null_model.model.J;
  const GaussianPrior prior = hypotheses.PriorWith({}, null_model.posterior.scale);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  SimulatedHealthy healthy{.drawn = draws};
  Eigen::MatrixXd z(prior.sigma.size(), draws);
  Eigen::MatrixXd noise(J.rows(), draws);
  for (int draw = 0; draw < draws; ++draw) {
    z.col(draw) = DrawHealthy(hypotheses, prior, &random);
    for (double& value : noise.col(draw)) value = normal(random);
  }
  const Eigen::MatrixXd b =
      linalg::TransposedProduct(J, linalg::Product(J, z) + noise);  // [parameters x draws]
  std::vector<double> most;
  for (int draw = 0; draw < draws; ++draw) {
    Eigen::Index fault = 0;
    most.push_back(comparison.LnBayesFactors(b.col(draw)).maxCoeff(&fault));
    if (most.back() < clear_evidence) continue;
    Eigen::VectorXd mean;
    comparison.LnBayesFactor(static_cast<int>(fault), b.col(draw), &mean);
    healthy.accused +=
        IsBeyondTolerances(hypotheses, static_cast<int>(fault), mean, least_tolerances) ? 1 : 0;
  }
  std::sort(most.begin(), most.end());
  if (!most.empty()) {
    healthy.ln_bayes_factor_98 =
        most[static_cast<std::size_t>(kQuantile * static_cast<double>(most.size() - 1))];
  }
  return healthy;
}

}  // namespace palpate::diagnosis
