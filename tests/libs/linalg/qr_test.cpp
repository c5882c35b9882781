// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/linalg/qr.hpp"

#include <gtest/gtest.h>

#include "tests/libs/linalg/random_matrix.hpp"

namespace palpate::linalg {
namespace {

TEST(DecomposeQr, SpansTheColumnsInTheirOrder) {
  for (const Eigen::Index rows : {5, 20, 150}) {
    const Eigen::MatrixXd A = RandomMatrix(rows, 5, 1);
    const ThinQr qr = DecomposeQr(A);
    EXPECT_LE(OrthonormalError(qr.Q), 1e-13);
    const Eigen::MatrixXd R = qr.Q.transpose() * A;
    EXPECT_LE((qr.Q * R - A).norm(), 1e-13 * A.norm());
    EXPECT_LE((R.diagonal() - qr.R_diagonal).norm(), 1e-13 * A.norm());
    for (Eigen::Index j = 0; j < 5; ++j) EXPECT_LE(R.col(j).tail(4 - j).norm(), 1e-12);
  }
}

TEST(OrthonormalBasis, HasTheRankOfTheMatrix) {
  const Eigen::MatrixXd A = RandomMatrix(12, 3, 2) * RandomMatrix(3, 8, 3);
  const Eigen::MatrixXd Q = OrthonormalBasis(A);
  ASSERT_EQ(Q.cols(), 3);
  EXPECT_LE(OrthonormalError(Q), 1e-13);
  EXPECT_LE((Q * (Q.transpose() * A) - A).norm(), 1e-13 * A.norm());
  EXPECT_EQ(OrthonormalBasis(Eigen::MatrixXd::Zero(4, 2)).cols(), 0);
  EXPECT_EQ(OrthonormalBasis(Eigen::MatrixXd(4, 0)).rows(), 4);
}

TEST(OrthonormalBasis, LeavesOutWhatIsBelowTheThreshold) {
  const Eigen::Vector3d sizes(1.0, 1e-3, 1e-7);
  EXPECT_EQ(OrthonormalBasis(sizes.asDiagonal()).cols(), 3);
  EXPECT_EQ(OrthonormalBasis(sizes.asDiagonal(), 1e-5).cols(), 2);
  EXPECT_EQ(OrthonormalBasis(Eigen::MatrixXd(0, 2), 1e-5).size(), 0);
}

TEST(LeastSquares, LeavesAResidualNormalToTheColumns) {
  const Eigen::MatrixXd A = RandomMatrix(40, 6, 4);
  const Eigen::MatrixXd B = RandomMatrix(40, 3, 5);
  const Eigen::VectorXd b = B.col(2);
  EXPECT_LE((A.transpose() * (A * LeastSquares(A, B) - B)).norm(), 1e-12 * B.norm());
  EXPECT_LE((LeastSquares(A, b) - LeastSquares(A, B).col(2)).norm(), 1e-12);
}

TEST(LeastSquares, OfDependentColumnsIsStillTheLeast) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    Eigen::MatrixXd A = RandomMatrix(20, 4, 2 * seed);
    A.col(3) = A.col(0) + A.col(1);
    const Eigen::MatrixXd B = RandomMatrix(20, 2, 2 * seed + 1);
    const Eigen::VectorXd x = LeastSquares(A, Eigen::VectorXd(B.col(0)));
    EXPECT_LE((A.transpose() * (A * x - B.col(0))).norm(), 1e-12 * B.norm());
    EXPECT_EQ((x.array() == 0.0).count(), 1);
    EXPECT_LE(x.norm(), 10.0);
    EXPECT_LE((LeastSquares(A, B).col(0) - x).norm(), 1e-12);
  }
}

TEST(LeastSquares, OfWhatIsNotFiniteIsNot) {
  Eigen::MatrixXd A = RandomMatrix(9, 3, 8);
  A(4, 1) = kNaN;
  EXPECT_FALSE(LeastSquares(A, Eigen::VectorXd(Eigen::VectorXd::Ones(9))).allFinite());
}

TEST(QrDeathTest, RefusesWhatDoesNotFit) {
  EXPECT_DEATH(DecomposeQr(RandomMatrix(2, 3, 9)), "2 3");
  EXPECT_DEATH(LeastSquares(RandomMatrix(4, 3, 9), Eigen::VectorXd(Eigen::VectorXd::Ones(5))),
               "4 3 5");
}

}  // namespace
}  // namespace palpate::linalg
