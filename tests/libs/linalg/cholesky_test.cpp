// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/linalg/cholesky.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/libs/linalg/random_matrix.hpp"

namespace palpate::linalg {
namespace {

constexpr double kRounding = 1e-11;

TEST(Cholesky, SolvesWhatItFactored) {
  for (const Eigen::Index size : {1, 2, 7, 16, 60, 200}) {
    const Eigen::MatrixXd A = RandomSpd(size, 1);
    const Eigen::MatrixXd B = RandomMatrix(size, 3, 2);
    const Eigen::VectorXd b = B.col(0);
    const Cholesky factor(A);
    ASSERT_TRUE(factor.ok()) << size;
    EXPECT_LE((A * factor.Solve(B) - B).norm(), kRounding * B.norm()) << size;
    EXPECT_LE((A * factor.Solve(b) - b).norm(), kRounding * b.norm()) << size;
    EXPECT_LE((A * factor.Inverse() - Eigen::MatrixXd::Identity(size, size)).norm(), kRounding * 60)
        << size;
    EXPECT_LE((factor.Lower() * factor.Lower().transpose() - A).norm(), kRounding * A.norm());
  }
}

TEST(Cholesky, DeterminantIsThatOfAScaledIdentityAndOfAProduct) {
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(5, 5);
  EXPECT_NEAR(Cholesky(4.0 * I).LnDeterminant(), 5.0 * std::log(4.0), kRounding);
  const Eigen::MatrixXd A = RandomSpd(5, 3);
  EXPECT_NEAR(Cholesky(A * A).LnDeterminant(), 2.0 * Cholesky(A).LnDeterminant(), 1e-8);
}

TEST(Cholesky, ReadsTheLowerTriangleOnly) {
  const Eigen::MatrixXd A = RandomSpd(6, 4);
  Eigen::MatrixXd lower = A;
  for (Eigen::Index j = 1; j < 6; ++j) lower.col(j).head(j).setConstant(kNaN);
  EXPECT_EQ(Cholesky(lower).Inverse(), Cholesky(A).Inverse());
  EXPECT_EQ(InverseSymmetric(lower), InverseSymmetric(A));
}

TEST(Cholesky, RefusesWhatIsNotPositiveDefinite) {
  const Eigen::Vector2d signs(1.0, -1.0);
  EXPECT_FALSE(Cholesky(signs.asDiagonal()).ok());
  EXPECT_FALSE(Cholesky(Eigen::MatrixXd::Zero(3, 3)).ok());
  Eigen::MatrixXd A = RandomSpd(4, 5);
  A(3, 1) = kNaN;
  EXPECT_FALSE(Cholesky(A).ok());
  EXPECT_TRUE(Cholesky(Eigen::MatrixXd(0, 0)).ok());
  EXPECT_EQ(Cholesky(Eigen::MatrixXd(0, 0)).LnDeterminant(), 0.0);
}

TEST(CholeskyDeathTest, RefusesWhatDoesNotFit) {
  EXPECT_DEATH(Cholesky(Eigen::MatrixXd::Ones(3, 2)), "3 2");
  const Cholesky factor(RandomSpd(3, 6));
  EXPECT_DEATH(factor.Solve(Eigen::VectorXd(Eigen::VectorXd::Ones(4))), "3 4");
  EXPECT_DEATH(SolveSymmetric(RandomSpd(3, 6), Eigen::VectorXd(Eigen::VectorXd::Ones(2))), "3 2");
}

TEST(InverseSpd, IsTheInverseOrLeavesWhatWasThere) {
  const SmallMatrix A = RandomSpd(9, 7);
  SmallMatrix inverse;
  ASSERT_TRUE(InverseSpd(A, &inverse));
  EXPECT_LE((A * inverse - SmallMatrix::Identity(9, 9)).norm(), kRounding * 10);
  const SmallMatrix before = inverse;
  EXPECT_FALSE(InverseSpd(-A, &inverse));
  SmallMatrix unknown = A;
  unknown(8, 8) = kNaN;
  EXPECT_FALSE(InverseSpd(unknown, &inverse));
  EXPECT_EQ(inverse, before);
}

TEST(SolveSpdInPlace, SolvesInSinglePrecisionOrLeavesWhatWasThere) {
  const Eigen::MatrixXf A = RandomSpd(40, 8).cast<float>();
  const Eigen::VectorXf b = RandomMatrix(40, 1, 9).cast<float>();
  Eigen::MatrixXf overwritten = A;
  Eigen::VectorXf x;
  ASSERT_TRUE(SolveSpdInPlace(&overwritten, b, &x));
  EXPECT_LE((A * x - b).norm(), 1e-4f * b.norm());
  const Eigen::VectorXf before = x;
  overwritten = -A;
  EXPECT_FALSE(SolveSpdInPlace(&overwritten, b, &x));
  overwritten.setConstant(std::numeric_limits<float>::quiet_NaN());
  EXPECT_FALSE(SolveSpdInPlace(&overwritten, b, &x));
  EXPECT_EQ(x, before);
}

TEST(SolveSymmetric, SolvesDefiniteAndNegativeDefinite) {
  for (const double sign : {1.0, -1.0}) {
    const Eigen::MatrixXd A = sign * RandomSpd(30, 10);
    const Eigen::MatrixXd B = RandomMatrix(30, 4, 11);
    const Eigen::VectorXd b = B.col(1);
    EXPECT_LE((A * SolveSymmetric(A, B) - B).norm(), kRounding * B.norm());
    EXPECT_LE((A * SolveSymmetric(A, b) - b).norm(), kRounding * b.norm());
    EXPECT_LE((A * InverseSymmetric(A) - Eigen::MatrixXd::Identity(30, 30)).norm(), 1e-10);
  }
}

TEST(SolveSymmetric, LeavesOutWhatTheMatrixMapsToZero) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3, 3);
  A(0, 0) = 2.0;
  A(2, 2) = 4.0;
  const Eigen::VectorXd b = Eigen::Vector3d(2.0, 5.0, 8.0);
  EXPECT_EQ(SolveSymmetric(A, b), Eigen::VectorXd(Eigen::Vector3d(1.0, 0.0, 2.0)));
  A(2, 2) = kNaN;
  EXPECT_FALSE(SolveSymmetric(A, b).allFinite());
}

}  // namespace
}  // namespace palpate::linalg
