// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/linalg/svd.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "tests/libs/linalg/random_matrix.hpp"

namespace palpate::linalg {
namespace {

TEST(Svd, ReconstructsTheMatrix) {
  for (const auto& [rows, cols] :
       {std::pair(1, 1), std::pair(3, 40), std::pair(30, 4), std::pair(60, 50), std::pair(1, 2)}) {
    const Eigen::MatrixXd A = RandomMatrix(rows, cols, 1);
    const ThinSvd svd = DecomposeSvd(A);
    EXPECT_EQ(svd.values.size(), std::min(rows, cols));
    EXPECT_LE((svd.U * svd.values.asDiagonal() * svd.V.transpose() - A).norm(), 1e-12 * A.norm());
    EXPECT_LE(OrthonormalError(svd.U), 1e-12);
    EXPECT_LE(OrthonormalError(svd.V), 1e-12);
    EXPECT_LE((SingularValues(A) - svd.values).norm(), 1e-12 * A.norm());
    for (Eigen::Index k = 1; k < svd.values.size(); ++k) {
      EXPECT_GE(svd.values[k - 1], svd.values[k]);
    }
    EXPECT_GE(svd.values.minCoeff(), 0.0);
  }
}

TEST(Svd, OfATallMatrixIsTheSame) {
  const Eigen::MatrixXd A = RandomMatrix(80, 5, 2);
  const LeftSvd tall = DecomposeTall(A);
  EXPECT_LE((tall.values - DecomposeSvd(A).values).norm(), 1e-12 * A.norm());
  EXPECT_LE(OrthonormalError(tall.U), 1e-12);
  const Eigen::MatrixXd squares =
      tall.U * tall.values.cwiseAbs2().asDiagonal() * tall.U.transpose();
  EXPECT_LE((squares - A * A.transpose()).norm(), 1e-12 * A.squaredNorm());
}

TEST(Svd, CountsTheRank) {
  const Eigen::VectorXd values = SingularValues(RandomMatrix(9, 2, 3) * RandomMatrix(2, 6, 4));
  EXPECT_EQ((values.array() > 1e-12 * values[0]).count(), 2);
}

TEST(Svd, OfNothingIsNothing) {
  EXPECT_EQ(DecomposeSvd(Eigen::MatrixXd(4, 0)).U.rows(), 4);
  EXPECT_EQ(DecomposeSvd(Eigen::MatrixXd(0, 3)).V.rows(), 3);
  EXPECT_EQ(DecomposeTall(Eigen::MatrixXd(4, 0)).U.cols(), 0);
  EXPECT_EQ(SingularValues(Eigen::MatrixXd(4, 0)).size(), 0);
}

}  // namespace
}  // namespace palpate::linalg
