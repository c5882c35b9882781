// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/goodness_of_fit.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "components/diagnosis/inference/residual_statistics.hpp"

namespace palpate::diagnosis {

namespace {

/// A gap smaller than this share of the noise's chi-squared may be the mesh's: its errors, a per
/// cent of some 10 mm, are not quite the constants that NoiseModel takes them for.
constexpr double kLeastExcess = 0.15;
/// Of the bootstrap: one right model in so many fails.
constexpr double kFalseAlarms = 0.02;

}  // namespace

GoodnessOfFit TestGoodnessOfFit(const ObservedExperiment& observed,
                                const Eigen::Matrix3Xd& marker_rest_m,
                                const HypothesisSet& hypotheses, const Fit& fit, int draws,
                                std::uint64_t seed) {
  const LinearModel& model = fit.model;
  const ResidualStatistics residual_statistics(observed, marker_rest_m, model);
  const GaussianPrior prior = hypotheses.PriorWith(fit.faults);
  // The residual of the posterior mean is linear in what is measured.
  const auto residual_of = [&](const Eigen::VectorXd& off) -> Eigen::VectorXd {
    return off - model.J * (fit.posterior.covariance * (model.J.transpose() * off));
  };
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd drawn(residual_statistics.count(), draws);
  for (int d = 0; d < draws; ++d) {
    Eigen::VectorXd z =
        Eigen::VectorXd::NullaryExpr(prior.sigma.size(), [&] { return normal(random); });
    z = z.cwiseProduct(prior.sigma);
    for (const Eigen::Index p : hypotheses.ParametersOf(fit.faults)) z[p] = 0.0;
    const Eigen::VectorXd noise =
        Eigen::VectorXd::NullaryExpr(model.y.size(), [&] { return normal(random); });
    drawn.col(d) = residual_statistics.Of(residual_of(model.J * z + noise));
  }
  const Eigen::VectorXd mean = drawn.rowwise().mean();
  const Eigen::VectorXd deviation =
      ((drawn.colwise() - mean).rowwise().squaredNorm() / (draws - 1)).cwiseSqrt().cwiseMax(1e-9);
  const auto standardised = [&](const Eigen::VectorXd& tests) -> Eigen::VectorXd {
    return (tests - mean).cwiseQuotient(deviation);
  };
  std::vector<double> worst_of_draws;
  for (int d = 0; d < draws; ++d) {
    worst_of_draws.push_back(standardised(drawn.col(d)).maxCoeff());
  }
  std::sort(worst_of_draws.begin(), worst_of_draws.end());
  const auto rank = static_cast<std::size_t>((1.0 - kFalseAlarms) * (draws - 1));
  const Eigen::VectorXd tests = residual_statistics.Of(model.y - model.J * fit.posterior.mean);
  GoodnessOfFit result;
  Eigen::Index worst = 0;
  result.surprise = standardised(tests).maxCoeff(&worst);
  result.worst = residual_statistics.NameOf(worst);
  const double expected = mean[residual_statistics.MisfitBeside(worst)];
  result.excess = (tests[worst] - mean[worst]) / expected;
  result.surprise_limit = worst_of_draws[rank];
  result.passed = result.surprise <= result.surprise_limit || result.excess < kLeastExcess;
  return result;
}

}  // namespace palpate::diagnosis
