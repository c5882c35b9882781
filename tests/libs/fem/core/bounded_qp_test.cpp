// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/bounded_qp.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

#include "libs/linalg/lu.hpp"
#include "libs/linalg/symmetric_eigen.hpp"
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
      const linalg::Lu factor(qp.H(free, free));
      if (!(factor.ReciprocalCondition() > 1e-14)) continue;
      const Eigen::VectorXd gradient = qp.H * x + qp.c;
      x(free) = factor.Solve(Eigen::VectorXd(-gradient(free)));
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

/// The same, but for variables whose bounds are equal: any multiplier is right there.
double KktViolationOfOthers(const BoundedQp& qp, const QpVector& x) {
  const QpVector gradient = qp.H * x + qp.c;
  const QpVector moved = (x - gradient).cwiseMax(qp.lower).cwiseMin(qp.upper);
  return (moved - x).cwiseAbs().maxCoeff();
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

TEST(BoundedQp, FallsWithoutEndWhereADirectionOfDescentMeetsNoBound) {
  std::mt19937 engine(22);
  const auto below = [&](int count) {
    return static_cast<int>(engine() % static_cast<unsigned>(count));
  };
  for (int trial = 0; trial < 500; ++trial) {
    const int n = 2 + trial % 15;
    BoundedQp qp = RandomQp(n, 1 + below(n - 1), false, &engine);
    const QpVector flat = linalg::DecomposeSymmetric(qp.H).vectors.col(0);
    qp.c = -qp.H * Eigen::VectorXd(laws::RandomVector(n, 2.0, &engine)) - flat;
    for (int i = 0; i < n; ++i) {
      if (flat[i] > 0.0) qp.upper[i] = kInfinity;
      if (flat[i] < 0.0) qp.lower[i] = -kInfinity;
    }
    const QpVector start = laws::RandomVector(n, 3.0, &engine);
    EXPECT_EQ(SolveBoundedQp(qp, start).status.code(), StatusCode::kUnobservable) << trial;
    // With bounds on every side there is a minimum.
    qp.lower = -QpVector::Constant(n, 1e3);
    qp.upper = QpVector::Constant(n, 1e3);
    const BoundedQpResult result = SolveBoundedQp(qp, start);
    ASSERT_TRUE(result.status.ok()) << trial;
    EXPECT_LE(result.kkt_residual, 1e-9) << trial;
  }
}

TEST(BoundedQp, EqualBoundsHoldTheirVariable) {
  std::mt19937 engine(23);
  for (int trial = 0; trial < 100; ++trial) {
    BoundedQp qp = RandomQp(6, 6, false, &engine);
    qp.lower[2] = qp.upper[2] = 0.3;
    qp.lower[4] = qp.upper[4] = -1.7;
    const BoundedQpResult result = SolveBoundedQp(qp, QpVector::Zero(6));
    ASSERT_TRUE(result.status.ok());
    EXPECT_EQ(result.x[2], 0.3);
    EXPECT_EQ(result.x[4], -1.7);
    EXPECT_LE(KktViolationOfOthers(qp, result.x), 1e-10);
  }
}

/// The flat direction is (1, -1, 0, ..) up to rounding, whose bounds must not count as an end.
TEST(BoundedQp, RoundingOfTheFlatDirectionFindsNoBound) {
  std::mt19937 engine(17);
  for (int trial = 0; trial < 200; ++trial) {
    const int n = 3 + trial % 10;
    Eigen::MatrixXd G = laws::RandomVector(n * n, 1.0, &engine).reshaped(n, n);
    G.col(1) = G.col(0);
    BoundedQp qp{G.transpose() * G, QpVector::Zero(n), QpVector::Constant(n, -1.0),
                 QpVector::Constant(n, 1.0)};
    qp.c[0] = 1.0;
    qp.c[1] = -1.0;
    qp.lower.head(2).setConstant(-kInfinity);
    qp.upper.head(2).setConstant(kInfinity);
    EXPECT_EQ(SolveBoundedQp(qp, QpVector::Zero(n)).status.code(), StatusCode::kUnobservable)
        << trial;
  }
}

TEST(BoundedQp, AVariableOnWhichNothingActsGoesWhereItsCostSendsIt) {
  QpMatrix H = QpMatrix::Zero(4, 4);
  H(0, 0) = 4.0;
  BoundedQp qp{H, Eigen::Vector4d(-4.0, 1e-7, -1e7, 0.0), Eigen::Vector4d(-9.0, -1e8, -1e-8, -1.0),
               Eigen::Vector4d(9.0, kInfinity, 1e-8, 1.0)};
  const BoundedQpResult result = SolveBoundedQp(qp, Eigen::Vector4d(0.0, 0.0, 0.0, 0.25));
  ASSERT_TRUE(result.status.ok());
  EXPECT_EQ(result.x, Eigen::Vector4d(1.0, -1e8, 1e-8, 0.25));
  qp.c[1] = -1e-7;  // there is no bound on that side
  EXPECT_EQ(SolveBoundedQp(qp, QpVector::Zero(4)).status.code(), StatusCode::kUnobservable);
}

TEST(BoundedQp, AFarStartCostsNoAccuracy) {
  std::mt19937 engine(24);
  for (int trial = 0; trial < 100; ++trial) {
    BoundedQp qp = RandomQp(7, 7, false, &engine);
    qp.H += QpMatrix::Identity(7, 7);
    qp.lower.setConstant(-kInfinity);
    qp.upper.setConstant(kInfinity);
    const BoundedQpResult result = SolveBoundedQp(qp, laws::RandomVector(7, 1e10, &engine));
    ASSERT_TRUE(result.status.ok());
    const Eigen::VectorXd gradient = qp.H * result.x + qp.c;
    EXPECT_LE(gradient.norm(), 1e-12);
  }
}

TEST(BoundedQp, RoundingOfAFarStartIsNoSlope) {
  std::mt19937 engine(26);
  for (int trial = 0; trial < 500; ++trial) {
    BoundedQp qp = RandomQp(2, 1, false, &engine);
    qp.c.setZero();
    qp.lower.setConstant(-kInfinity);
    qp.upper = Eigen::Vector2d(0.0, kInfinity);
    // With the first variable at its bound, the minimum is 0: all that is left there is rounding.
    const Eigen::Vector2d start(0.0, laws::RandomVector(1, 1e6, &engine)[0]);
    ASSERT_TRUE(SolveBoundedQp(qp, start).status.ok()) << "trial " << trial;
  }
}

TEST(BoundedQp, CountsTheMeanOfAMatrixAndItsTransposed) {
  std::mt19937 engine(25);
  const BoundedQp even = RandomQp(5, 5, false, &engine);
  BoundedQp skewed = even;
  skewed.H(0, 3) += 0.25;
  skewed.H(3, 0) -= 0.25;
  const QpVector zero = QpVector::Zero(5);
  EXPECT_LE((SolveBoundedQp(even, zero).x - SolveBoundedQp(skewed, zero).x).norm(), 1e-12);
}

TEST(BoundedQp, AResultThatIsNotOkReportsNoResidual) {
  EXPECT_FALSE(BoundedQpResult{}.status.ok());
  EXPECT_EQ(BoundedQpResult{}.kkt_residual, kInfinity);
  const Eigen::Vector2d one(1.0, 1.0);
  const BoundedQp crossed{Eigen::Matrix2d::Identity(), one, one, -one};
  EXPECT_EQ(SolveBoundedQp(crossed, QpVector::Zero(2)).kkt_residual, kInfinity);
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

TEST(BoundedQp, RefusesInfinitiesThatLeaveNoFiniteAnswer) {
  const Eigen::Vector2d one(1.0, 1.0);
  const BoundedQp good{Eigen::Matrix2d::Identity(), one, -one, one};
  const QpVector start = QpVector::Zero(2);
  const auto refuses = [&](const BoundedQp& qp, const QpVector& from) {
    const BoundedQpResult result = SolveBoundedQp(qp, from);
    return result.status.code() == StatusCode::kInvalidInput && result.x == from;
  };
  BoundedQp bad = good;
  bad.lower[1] = bad.upper[1] = kInfinity;
  EXPECT_TRUE(refuses(bad, start));
  bad.lower[1] = bad.upper[1] = -kInfinity;
  EXPECT_TRUE(refuses(bad, start));
  bad = good;
  bad.H(1, 1) = kInfinity;
  EXPECT_TRUE(refuses(bad, start));
  bad = good;
  bad.c[0] = -kInfinity;
  EXPECT_TRUE(refuses(bad, start));
  bad = good;
  bad.H(0, 0) = 1e-300;  // the minimum is at -1e600
  bad.c[0] = 1e300;
  bad.lower[0] = -kInfinity;
  EXPECT_TRUE(refuses(bad, start));
  EXPECT_TRUE(refuses(good, Eigen::Vector2d(kInfinity, 0.0)));
}

}  // namespace
}  // namespace palpate::fem
