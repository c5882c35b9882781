// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/bounded_qp.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <random>

#include "tests/libs/fem/core/laws.hpp"

namespace palpate::fem {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A problem of `n` variables whose H has this rank. Coarse numbers (multiples of 1/2) make ties:
/// bounds that touch, multipliers that vanish.
BoundedQp RandomQp(int n, int rank, bool coarse, std::mt19937* engine) {
  const auto random = [&](Eigen::Index size) {
    Eigen::VectorXd values = laws::RandomVector(size, 2.0, engine);
    if (coarse) values = (2.0 * values).array().round() / 2.0;
    return values;
  };
  const Eigen::MatrixXd root = random(n * rank).reshaped(n, rank);
  BoundedQp qp{root * root.transpose(), random(n), random(n), random(n)};
  const QpVector lower = qp.lower.cwiseMin(qp.upper);
  qp.upper = qp.lower.cwiseMax(qp.upper);
  qp.lower = lower;
  return qp;
}

double Objective(const BoundedQp& qp, const QpVector& x) {
  return 0.5 * x.dot(qp.H * x) + qp.c.dot(x);
}

/// Smallest objective over every choice of variables at their lower bound, at their upper bound, or
/// free. (Where H is singular over the free ones, another choice is as good: bounds are finite.)
double BruteForceMinimum(const BoundedQp& qp) {
  const auto n = static_cast<int>(qp.c.size());
  double best = kInfinity;
  int choices = 1;
  for (int i = 0; i < n; ++i) choices *= 3;
  for (int choice = 0; choice < choices; ++choice) {
    QpVector x(n);
    std::vector<Eigen::Index> free;
    for (int i = 0, rest = choice; i < n; ++i, rest /= 3) {
      if (rest % 3 == 2) free.push_back(i);
      x[i] = rest % 3 == 0 ? qp.lower[i] : rest % 3 == 1 ? qp.upper[i] : 0.0;
    }
    if (!free.empty()) {
      const Eigen::FullPivLU<Eigen::MatrixXd> factor(Eigen::MatrixXd(qp.H(free, free)));
      if (!factor.isInvertible()) continue;
      const Eigen::VectorXd gradient = qp.H * x + qp.c;
      x(free) = factor.solve(-gradient(free));
    }
    const bool feasible = (x.array() >= qp.lower.array() - 1e-12).all() &&
                          (x.array() <= qp.upper.array() + 1e-12).all();
    if (feasible) best = std::min(best, Objective(qp, x));
  }
  return best;
}

/// Largest violation of feasibility or of stationarity.
double KktViolation(const BoundedQp& qp, const QpVector& x) {
  const QpVector gradient = qp.H * x + qp.c;
  double worst = 0.0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    worst = std::max({worst, qp.lower[i] - x[i], x[i] - qp.upper[i]});
    if (x[i] > qp.lower[i]) worst = std::max(worst, gradient[i]);
    if (x[i] < qp.upper[i]) worst = std::max(worst, -gradient[i]);
  }
  return worst;
}

TEST(BoundedQp, FindsTheMinimumThatEnumerationFinds) {
  std::mt19937 engine(17);
  for (int trial = 0; trial < 2400; ++trial) {
    const int n = 1 + trial % 6;
    const int rank = std::max(1, trial / 6 % 3 == 0 ? n / 2 : n);
    const BoundedQp qp = RandomQp(n, rank, trial / 18 % 2 == 0, &engine);
    const BoundedQpResult result = SolveBoundedQp(qp, laws::RandomVector(n, 3.0, &engine));
    ASSERT_TRUE(result.status.ok()) << "trial " << trial;
    const double expected = BruteForceMinimum(qp);
    ASSERT_NEAR(Objective(qp, result.x), expected, 1e-10 * (1.0 + std::abs(expected)))
        << "trial " << trial;
    ASSERT_LE(KktViolation(qp, result.x), 1e-8) << "trial " << trial;
    EXPECT_LE(result.kkt_residual, 1e-8);
  }
}

TEST(BoundedQp, MeetsTheOptimalityConditionsWithManyVariables) {
  std::mt19937 engine(18);
  for (int trial = 0; trial < 500; ++trial) {
    const int n = 7 + trial % 10;
    const BoundedQp qp = RandomQp(n, trial % 3 == 0 ? n - 3 : n, trial % 2 == 0, &engine);
    const BoundedQpResult result = SolveBoundedQp(qp, QpVector::Zero(n));
    ASSERT_TRUE(result.status.ok()) << "trial " << trial;
    ASSERT_LE(KktViolation(qp, result.x), 1e-8) << "trial " << trial;
  }
}

TEST(BoundedQp, DoesNotDependOnTheUnitsOfItsVariables) {
  std::mt19937 engine(19);
  for (int trial = 0; trial < 100; ++trial) {
    const BoundedQp qp = RandomQp(5, 5, false, &engine);
    const Eigen::VectorXd unit = Eigen::VectorXd::LinSpaced(5, -6.0, 6.0).unaryExpr([](double e) {
      return std::pow(10.0, e);
    });
    BoundedQp scaled{unit.asDiagonal() * qp.H * unit.asDiagonal(), unit.cwiseProduct(qp.c),
                     qp.lower.cwiseQuotient(unit), qp.upper.cwiseQuotient(unit)};
    const QpVector zero = QpVector::Zero(5);
    const BoundedQpResult a = SolveBoundedQp(qp, zero);
    const BoundedQpResult b = SolveBoundedQp(scaled, zero);
    ASSERT_TRUE(a.status.ok() && b.status.ok());
    EXPECT_LE((unit.cwiseProduct(b.x) - a.x).norm(), 1e-9);
  }
}

TEST(BoundedQp, TheSolutionAsStartIsFoundAtOnce) {
  std::mt19937 engine(20);
  for (int trial = 0; trial < 100; ++trial) {
    const BoundedQp qp = RandomQp(8, 8, false, &engine);
    const BoundedQpResult cold = SolveBoundedQp(qp, QpVector::Zero(8));
    const BoundedQpResult warm = SolveBoundedQp(qp, cold.x);
    ASSERT_TRUE(warm.status.ok());
    EXPECT_EQ(warm.iterations, 1);
    EXPECT_LE((warm.x - cold.x).norm(), 1e-10);
  }
}

TEST(BoundedQp, GoesToTheBoundWhereTheObjectiveHasNoCurvature) {
  const BoundedQp qp{QpMatrix::Zero(2, 2), Eigen::Vector2d(1.0, -3.0), Eigen::Vector2d(-4.0, -1.0),
                     Eigen::Vector2d(2.0, 5.0)};
  const BoundedQpResult result = SolveBoundedQp(qp, QpVector::Zero(2));
  ASSERT_TRUE(result.status.ok());
  EXPECT_EQ(result.x, Eigen::Vector2d(-4.0, 5.0));
  EXPECT_EQ(result.kkt_residual, 0.0);
}

TEST(BoundedQp, AProblemWithoutMinimumIsUnobservable) {
  const Eigen::Vector2d free = Eigen::Vector2d::Constant(kInfinity);
  const Eigen::Matrix2d H = Eigen::Matrix2d::Ones();  // no curvature along (1, -1)
  const BoundedQp unbounded{H, Eigen::Vector2d(1.0, -1.0), -free, free};
  EXPECT_EQ(SolveBoundedQp(unbounded, QpVector::Zero(2)).status.code(), StatusCode::kUnobservable);
  const BoundedQp bounded{H, Eigen::Vector2d(1.0, -1.0), Eigen::Vector2d(-3.0, -kInfinity), free};
  const BoundedQpResult result = SolveBoundedQp(bounded, QpVector::Zero(2));
  ASSERT_TRUE(result.status.ok());
  EXPECT_NEAR(result.x[0], -3.0, 1e-12);
  EXPECT_NEAR(result.x[1], 4.0, 1e-12);
}

TEST(BoundedQp, TakesTheSmallestStepWhereTheSolutionIsNotUnique) {
  const Eigen::Vector2d free = Eigen::Vector2d::Constant(kInfinity);
  const BoundedQp qp{Eigen::Matrix2d::Ones(), Eigen::Vector2d(-2.0, -2.0), -free, free};
  const BoundedQpResult result = SolveBoundedQp(qp, QpVector::Zero(2));
  ASSERT_TRUE(result.status.ok());
  EXPECT_LE((result.x - QpVector(Eigen::Vector2d(1.0, 1.0))).norm(), 1e-12);
}

TEST(BoundedQp, SolvesTheEmptyProblem) {
  EXPECT_TRUE(SolveBoundedQp({QpMatrix(0, 0), QpVector(0), QpVector(0), QpVector(0)}, QpVector(0))
                  .status.ok());
}

TEST(BoundedQp, RefusesNaNAndBoundsThatCross) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Vector2d one(1.0, 1.0);
  const BoundedQp good{Eigen::Matrix2d::Identity(), one, -one, one};
  const QpVector start = QpVector::Zero(2);
  EXPECT_TRUE(SolveBoundedQp(good, start).status.ok());
  const auto refuses = [&](const BoundedQp& qp, const QpVector& from) {
    return SolveBoundedQp(qp, from).status.code() == StatusCode::kInvalidInput;
  };
  BoundedQp bad = good;
  bad.H(0, 1) = nan;
  EXPECT_TRUE(refuses(bad, start));
  bad = good;
  bad.c[1] = nan;
  EXPECT_TRUE(refuses(bad, start));
  bad = good;
  bad.lower[0] = nan;
  EXPECT_TRUE(refuses(bad, start));
  bad = good;
  bad.lower[0] = 2.0;
  EXPECT_TRUE(refuses(bad, start));
  EXPECT_TRUE(refuses(good, Eigen::Vector2d(nan, 0.0)));
}

}  // namespace
}  // namespace palpate::fem
