// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/linalg/lu.hpp"

#include <gtest/gtest.h>

#include "tests/libs/linalg/random_matrix.hpp"

namespace palpate::linalg {
namespace {

constexpr double kLuRounding = 1e-10;

TEST(Lu, SolvesWhatIsNotSymmetric) {
  for (const Eigen::Index size : {1, 2, 9, 16, 80}) {
    const Eigen::MatrixXd A = RandomMatrix(size, size, 1);
    const Eigen::MatrixXd B = RandomMatrix(size, 3, 2);
    const Eigen::VectorXd b = B.col(0);
    const Lu lu(A);
    EXPECT_LE((A * lu.Solve(B) - B).norm(), kLuRounding * B.norm()) << size;
    EXPECT_LE((A * lu.Solve(b) - b).norm(), kLuRounding * b.norm()) << size;
    if (size <= kMaxSmallSize) {
      EXPECT_LE((A * SmallLu(A).Solve(b) - b).norm(), kLuRounding * b.norm()) << size;
    }
  }
}

TEST(Lu, ConditionIsThatOfADiagonalMatrix) {
  const Eigen::Vector3d entries(2.0, -8.0, 0.5);
  EXPECT_NEAR(Lu(entries.asDiagonal()).ReciprocalCondition(), 0.5 / 8.0, 1e-15);
  EXPECT_NEAR(SmallLu(SmallMatrix(entries.asDiagonal())).ReciprocalCondition(), 0.5 / 8.0, 1e-15);
}

TEST(Lu, ConditionTellsWhatIsSingularOrNotFinite) {
  Eigen::MatrixXd A = RandomMatrix(6, 6, 3);
  A.row(4) = 2.0 * A.row(1) - A.row(5);
  EXPECT_LT(Lu(A).ReciprocalCondition(), 1e-15);
  EXPECT_LT(SmallLu(A).ReciprocalCondition(), 1e-15);
  EXPECT_EQ(Lu(Eigen::MatrixXd::Zero(3, 3)).ReciprocalCondition(), 0.0);
  A(2, 3) = kNaN;
  EXPECT_FALSE(Lu(A).ReciprocalCondition() >= 0.0);
  EXPECT_FALSE(SmallLu(A).ReciprocalCondition() >= 0.0);
}

TEST(LuDeathTest, RefusesWhatDoesNotFit) {
  EXPECT_DEATH(Lu(Eigen::MatrixXd::Ones(3, 2)), "3 2");
  EXPECT_DEATH(SmallLu(SmallMatrix(SmallMatrix::Ones(2, 3))), "2 3");
  const Lu lu(RandomMatrix(3, 3, 4));
  EXPECT_DEATH(lu.Solve(Eigen::VectorXd(Eigen::VectorXd::Ones(4))), "4 3");
}

}  // namespace
}  // namespace palpate::linalg
