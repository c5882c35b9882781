// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/complementarity.hpp"

#include <gtest/gtest.h>

#include <random>

namespace palpate::diagnosis {
namespace {

/// As compliance has it: everything yields together, and each node a little by itself.
Eigen::MatrixXd Compliance(int count, double own, std::mt19937* random) {
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd modes =
      Eigen::MatrixXd::NullaryExpr(count, 3, [&] { return normal(*random); });
  return modes * modes.transpose() + own * Eigen::MatrixXd::Identity(count, count);
}

TEST(Complementarity, IsOfForcesThatPushAndGapsThatAreOpen) {
  constexpr unsigned kSeed = 7;
  constexpr double kExact = 1e-9;
  std::mt19937 random(kSeed);
  std::normal_distribution<double> normal;
  for (const int count : {1, 5, 40, 200}) {
    for (const double own : {1.0, 1e-2, 1e-4}) {
      const Eigen::MatrixXd M = Compliance(count, own, &random);
      const Eigen::VectorXd q =
          Eigen::VectorXd::NullaryExpr(count, [&](Eigen::Index) { return normal(random); });
      const Eigen::VectorXd start =
          Eigen::VectorXd::NullaryExpr(count, [&](Eigen::Index) { return normal(random); });
      const Eigen::VectorXd x = SolveComplementarity(M, q, start);
      const Eigen::VectorXd y = M * x + q;
      SCOPED_TRACE(testing::Message() << count << " unknowns, " << own << ", seed " << kSeed);
      EXPECT_GE(x.minCoeff(), 0.0);
      EXPECT_GT(y.minCoeff(), -kExact);
      EXPECT_LT((x.array() * y.array()).abs().maxCoeff(), kExact * (1.0 + x.maxCoeff()));
    }
  }
}

TEST(Complementarity, OfNothingPressedIsZero) {
  const Eigen::Matrix3d M = Eigen::Matrix3d::Identity();
  const Eigen::Vector3d x =
      SolveComplementarity(M, Eigen::Vector3d(0.1, 0.0, 2.0), Eigen::Vector3d::Ones());
  EXPECT_TRUE(x.isZero(0.0)) << x.transpose();
}

}  // namespace
}  // namespace palpate::diagnosis
