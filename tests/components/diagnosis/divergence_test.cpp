// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/design/divergence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "libs/linalg/cholesky.hpp"

namespace palpate::diagnosis {
namespace {

constexpr unsigned kDivergenceSeed = 20261123;
constexpr Eigen::Index kParameters = 4;
constexpr Eigen::Index kRows = 9;

class ExpectedEvidence : public testing::Test {
 protected:
  Eigen::MatrixXd Random(Eigen::Index rows, Eigen::Index cols) {
    std::normal_distribution<double> normal;
    return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return normal(random_); });
  }
  Posterior RandomPosterior() {
    const Eigen::MatrixXd root = Random(kParameters, kParameters);
    return {.mean = Random(kParameters, 1), .covariance = 0.3 * root * root.transpose()};
  }

  static double Expected(const Eigen::MatrixXd& J, const Posterior& a, const Posterior& b) {
    return ExpectedLnBayesFactor({J, a}, {J, b});
  }
  static double Gained(const Eigen::MatrixXd& J, const Posterior& posterior,
                       const std::vector<Eigen::Index>& parameters) {
    return InformationGain(J, posterior, parameters, {J, posterior});
  }

  std::mt19937 random_{kDivergenceSeed};
};

TEST_F(ExpectedEvidence, IsNothingBetweenAModelAndItself) {
  const Posterior posterior = RandomPosterior();
  EXPECT_NEAR(Expected(Random(kRows, kParameters), posterior, posterior), 0.0, 1e-10);
}

TEST_F(ExpectedEvidence, OfModelsThatPredictTheSameIsNothing) {
  const Posterior a = RandomPosterior();
  Posterior b = a;
  b.mean[2] += 3.0;
  b.covariance(2, 2) += 5.0;
  Eigen::MatrixXd J = Random(kRows, kParameters);
  J.col(2).setZero();
  EXPECT_NEAR(Expected(J, a, b), 0.0, 1e-10);
}

TEST_F(ExpectedEvidence, IsNeverBelowNothingAndGrowsWithTheData) {
  for (int k = 0; k < 50; ++k) {
    const Posterior a = RandomPosterior();
    const Posterior b = RandomPosterior();
    const Eigen::MatrixXd J = Random(kRows, kParameters);
    double before = 0.0;
    for (Eigen::Index rows = 1; rows <= kRows; ++rows) {
      const double now = Expected(J.topRows(rows), a, b);
      EXPECT_GT(now, before - 1e-9)
          << "seed " << kDivergenceSeed << " pair " << k << " rows " << rows;
      before = now;
    }
    EXPECT_GT(before, 0.0);
  }
}

TEST_F(ExpectedEvidence, OfKnownModelsIsHalfTheSquareOfWhatTheyDifferBy) {
  Posterior a = RandomPosterior();
  Posterior b = RandomPosterior();
  a.covariance.setZero();
  b.covariance.setZero();
  const Eigen::MatrixXd J = Random(kRows, kParameters);
  EXPECT_NEAR(Expected(J, a, b), 0.5 * (J * (a.mean - b.mean)).squaredNorm(), 1e-9);
}

/// What data of the one model say, drawn.
TEST_F(ExpectedEvidence, IsTheMeanOfWhatDataSay) {
  const Posterior a = RandomPosterior();
  const Posterior b = RandomPosterior();
  const Eigen::MatrixXd J = Random(kRows, kParameters);
  const auto ln_density = [&](const Eigen::VectorXd& y, const Posterior& model) {
    Eigen::MatrixXd covariance = J * model.covariance * J.transpose();
    covariance.diagonal().array() += 1.0;
    const Eigen::VectorXd off = y - J * model.mean;
    const linalg::Cholesky factor(covariance);
    return -0.5 * (off.dot(factor.Solve(off)) + factor.LnDeterminant());
  };
  const Eigen::MatrixXd root = linalg::Cholesky(a.covariance).Lower();
  constexpr int kDraws = 20000;
  double sum = 0.0;
  double squares = 0.0;
  for (int k = 0; k < kDraws; ++k) {
    const Eigen::VectorXd z = a.mean + root * Eigen::VectorXd(Random(kParameters, 1));
    const Eigen::VectorXd y = J * z + Random(kRows, 1);
    const double said = ln_density(y, a) - ln_density(y, b);
    sum += said;
    squares += said * said;
  }
  const double mean = sum / kDraws;
  const double sigma = std::sqrt((squares / kDraws - mean * mean) / kDraws);
  EXPECT_NEAR(Expected(J, a, b), mean, 4.0 * sigma) << "seed " << kDivergenceSeed;
}

TEST_F(ExpectedEvidence, InformationIsWhatAPosteriorShrinksBy) {
  const Posterior before = RandomPosterior();
  const Eigen::MatrixXd J = Random(kRows, kParameters);
  const Eigen::MatrixXd after =
      linalg::InverseSymmetric(linalg::InverseSymmetric(before.covariance) + J.transpose() * J);
  const std::vector<Eigen::Index> some = {1, 3};
  const double ln_ratio = linalg::Cholesky(before.covariance(some, some)).LnDeterminant() -
                          linalg::Cholesky(after(some, some)).LnDeterminant();
  EXPECT_NEAR(Gained(J, before, some), 0.5 * ln_ratio, 1e-6);
  EXPECT_NEAR(Gained(0.0 * J, before, some), 0.0, 1e-9);
  Posterior held = before;
  held.covariance.row(1).setZero();
  held.covariance.col(1).setZero();
  EXPECT_EQ(Gained(J, held, {1}), 0.0);
}

}  // namespace
}  // namespace palpate::diagnosis
