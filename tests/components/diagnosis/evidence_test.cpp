// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/evidence.hpp"

#include <gtest/gtest.h>

#include <random>

#include "libs/linalg/cholesky.hpp"

namespace palpate::diagnosis {
namespace {

constexpr unsigned kEvidenceSeed = 20261122;

/// y = J z + noise of unit variance.
struct Problem {
  explicit Problem(unsigned seed) : random(seed) {
    J = Random(14, 5);
    y = Random(14, 1);
  }

  Eigen::MatrixXd Random(Eigen::Index rows, Eigen::Index cols) {
    std::normal_distribution<double> normal;
    return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return normal(random); });
  }
  Information Of(Eigen::Index first, Eigen::Index count) const {
    Information information(J.cols());
    const auto rows = J.middleRows(first, count);
    information.H = rows.transpose() * rows;
    information.b = rows.transpose() * y.segment(first, count);
    information.c = y.segment(first, count).squaredNorm();
    information.rows = static_cast<int>(count);
    return information;
  }

  std::mt19937 random;
  Eigen::MatrixXd J;
  Eigen::VectorXd y;
};

/// GaussianPriors that differ by orders of magnitude, one of them held.
GaussianPrior SomePrior() {
  GaussianPrior prior(5);
  prior.sigma << 0.3, 2.0, 0.0, 50.0, 1e-3;
  prior.mean << 0.0, 1.5, -0.7, 0.0, 0.02;
  return prior;
}

/// What normal priors and data say, from the covariance of the data: no Woodbury.
Posterior Dense(const Problem& problem, const GaussianPrior& prior) {
  const Eigen::MatrixXd S = prior.sigma.array().square().matrix().asDiagonal();
  const Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(problem.y.size(), problem.y.size()) +
                                     problem.J * S * problem.J.transpose();
  const linalg::Cholesky factor(covariance);
  const Eigen::VectorXd off = problem.y - problem.J * prior.mean;
  Posterior posterior;
  posterior.misfit = off.dot(factor.Solve(off));
  posterior.ln_evidence = -0.5 * posterior.misfit - 0.5 * factor.LnDeterminant();
  const Eigen::MatrixXd gain = S * problem.J.transpose();
  posterior.mean = prior.mean + gain * factor.Solve(off);
  posterior.covariance = S - gain * factor.Solve(Eigen::MatrixXd(gain.transpose()));
  return posterior;
}

void ExpectAlike(const Posterior& inferred, const Posterior& dense) {
  EXPECT_NEAR(inferred.misfit, dense.misfit, 1e-9 * (1.0 + dense.misfit));
  EXPECT_NEAR(inferred.ln_evidence, dense.ln_evidence, 1e-9 * (1.0 + std::abs(dense.ln_evidence)));
  EXPECT_TRUE(inferred.mean.isApprox(dense.mean, 1e-8)) << inferred.mean.transpose() << "\n"
                                                        << dense.mean.transpose();
  EXPECT_TRUE(inferred.covariance.isApprox(dense.covariance, 1e-7)) << inferred.covariance << "\n\n"
                                                                    << dense.covariance;
}

TEST(Infer, IsWhatTheCovarianceOfTheDataSays) {
  for (unsigned seed = kEvidenceSeed; seed < kEvidenceSeed + 5; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Problem problem(seed);
    ExpectAlike(Infer(problem.Of(0, 14), SomePrior()), Dense(problem, SomePrior()));
  }
}

TEST(Infer, HoldsWhatIsBelievedForSure) {
  const Problem problem(kEvidenceSeed);
  GaussianPrior prior = SomePrior();
  const Posterior posterior = Infer(problem.Of(0, 14), prior);
  EXPECT_EQ(posterior.mean[2], -0.7);
  EXPECT_TRUE(posterior.covariance.row(2).isZero(0.0));
  // All held: the data as they are.
  prior.sigma.setZero();
  const Posterior held = Infer(problem.Of(0, 14), prior);
  EXPECT_NEAR(held.misfit, (problem.y - problem.J * prior.mean).squaredNorm(), 1e-9);
  EXPECT_EQ(held.mean, prior.mean);
}

TEST(Infer, ABeliefAboutAnotherMeanIsOneAboutShiftedData) {
  Problem problem(kEvidenceSeed);
  const GaussianPrior prior = SomePrior();
  GaussianPrior about_zero = prior;
  about_zero.mean.setZero();
  const Posterior moved = Infer(problem.Of(0, 14), prior);
  problem.y -= problem.J * prior.mean;
  const Posterior shifted = Infer(problem.Of(0, 14), about_zero);
  EXPECT_NEAR(moved.ln_evidence, shifted.ln_evidence, 1e-9 * std::abs(moved.ln_evidence));
  EXPECT_TRUE(moved.mean.isApprox(shifted.mean + prior.mean, 1e-9));
}

TEST(Information, WithoutAPartIsThatOfTheOthers) {
  const Problem problem(kEvidenceSeed);
  Information rest = problem.Of(0, 14);
  rest.Remove(problem.Of(0, 5));
  EXPECT_EQ(rest.rows, 9);
  ExpectAlike(Infer(rest, SomePrior()), Infer(problem.Of(5, 9), SomePrior()));
}

}  // namespace
}  // namespace palpate::diagnosis
