// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/guard.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace palpate::diagnosis {

namespace {

/// A gap smaller than this share of the noise's chi-squared may be the mesh's: its errors, a per
/// cent of some 10 mm, are not quite the constants that NoiseModel takes them for.
constexpr double kLeastExcess = 0.15;
/// Of the bootstrap: one right model in so many fails.
constexpr double kFalseAlarms = 0.02;

/// [tests] misfit of all rows, of each recording's, and products of each recording's neighbours.
Eigen::VectorXd Tests(const ObservedExperiment& observed, const LinearModel& model,
                      const Eigen::VectorXd& residual) {
  const auto recordings = std::ssize(observed.recordings);
  Eigen::VectorXd tests = Eigen::VectorXd::Zero(1 + 2 * recordings);
  for (Eigen::Index row = 0; row < residual.size(); ++row) {
    const auto k = static_cast<std::size_t>(row);
    const auto sample = static_cast<std::size_t>(model.sample_of_row[k]);
    const Eigen::Index recording = observed.samples[sample].recording;
    const double square = residual[row] * residual[row];
    tests[0] += square;
    tests[1 + recording] += square;
    const bool follows = row > 0 && model.coordinate_of_row[k] == model.coordinate_of_row[k - 1] &&
                         model.sample_of_row[k] == model.sample_of_row[k - 1] + 1;
    if (follows) tests[1 + recordings + recording] += residual[row] * residual[row - 1];
  }
  return tests;
}

std::string NameOf(const ObservedExperiment& observed, Eigen::Index test) {
  const auto recordings = std::ssize(observed.recordings);
  if (test == 0) return "misfit of all recordings";
  const bool runs = test > recordings;
  const auto recording = static_cast<std::size_t>((test - 1) % recordings);
  return (runs ? "runs in recording " : "misfit of recording ") +
         observed.recordings[recording].name;
}

}  // namespace

GuardResult Guard(const ObservedExperiment& observed, const CauseBook& book, const Fit& fit,
                  int draws, std::uint64_t seed) {
  const LinearModel& model = fit.model;
  const Belief belief = book.BeliefWith(fit.faults);
  // The residual of the posterior mean is linear in what is measured.
  const auto residual_of = [&](const Eigen::VectorXd& off) -> Eigen::VectorXd {
    return off - model.J * (fit.posterior.covariance * (model.J.transpose() * off));
  };
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd drawn(1 + 2 * std::ssize(observed.recordings), draws);
  for (int d = 0; d < draws; ++d) {
    Eigen::VectorXd z =
        Eigen::VectorXd::NullaryExpr(belief.sigma.size(), [&] { return normal(random); });
    z = z.cwiseProduct(belief.sigma);
    for (const Eigen::Index p : book.ParametersOf(fit.faults)) z[p] = 0.0;
    const Eigen::VectorXd noise =
        Eigen::VectorXd::NullaryExpr(model.y.size(), [&] { return normal(random); });
    drawn.col(d) = Tests(observed, model, residual_of(model.J * z + noise));
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
  const Eigen::VectorXd tests = Tests(observed, model, model.y - model.J * fit.posterior.mean);
  GuardResult result;
  Eigen::Index worst = 0;
  result.surprise = standardised(tests).maxCoeff(&worst);
  result.worst = NameOf(observed, worst);
  const double expected = mean[worst == 0 ? 0 : 1 + (worst - 1) % std::ssize(observed.recordings)];
  const double excess = (tests[worst] - mean[worst]) / expected;
  result.passed = result.surprise <= worst_of_draws[rank] || excess < kLeastExcess;
  return result;
}

}  // namespace palpate::diagnosis
