// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/linalg/symmetric_eigen.hpp"

#include <gtest/gtest.h>

#include "tests/libs/linalg/random_matrix.hpp"

namespace palpate::linalg {
namespace {

template <typename Decomposition>
void ExpectDecomposes(const Eigen::MatrixXd& A, const Decomposition& eigen) {
  ASSERT_TRUE(eigen.ok);
  const Eigen::MatrixXd again =
      eigen.vectors * eigen.values.asDiagonal() * eigen.vectors.transpose();
  EXPECT_LE((again - A).norm(), 1e-12 * A.norm());
  EXPECT_LE(OrthonormalError(eigen.vectors), 1e-12);
  for (Eigen::Index k = 1; k < A.rows(); ++k) EXPECT_LE(eigen.values[k - 1], eigen.values[k]);
}

TEST(SymmetricEigen, ReconstructsTheMatrix) {
  for (const Eigen::Index size : {1, 2, 5, 16, 70}) {
    const Eigen::MatrixXd root = RandomMatrix(size, size, 1);
    const Eigen::MatrixXd A = root + root.transpose();
    ExpectDecomposes(A, DecomposeSymmetric(A));
    EXPECT_LE((SymmetricEigenvalues(A) - DecomposeSymmetric(A).values).norm(), 1e-12 * A.norm());
    if (size <= kMaxSmallSize) ExpectDecomposes(A, DecomposeSymmetric(SmallMatrix(A)));
  }
}

TEST(SymmetricEigen, FindsTheNullSpaceOfASingularMatrix) {
  const Eigen::MatrixXd root = RandomMatrix(6, 4, 2);
  const Eigen::MatrixXd A = root * root.transpose();
  const SymmetricEigen eigen = DecomposeSymmetric(A);
  ASSERT_TRUE(eigen.ok);
  EXPECT_LE(eigen.values.head(2).cwiseAbs().maxCoeff(), 1e-14 * eigen.values[5]);
  EXPECT_LE((root.transpose() * eigen.vectors.leftCols(2)).norm(), 1e-6);
}

TEST(SymmetricEigen, RefusesWhatIsNotFinite) {
  Eigen::MatrixXd A = RandomSpd(5, 3);
  A(3, 2) = kNaN;
  EXPECT_FALSE(DecomposeSymmetric(A).ok);
  EXPECT_FALSE(DecomposeSymmetric(SmallMatrix(A)).ok);
  EXPECT_TRUE(SymmetricEigenvalues(A).array().isNaN().all());
  A(3, 2) = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(DecomposeSymmetric(A).ok);
}

TEST(SymmetricEigen, OfNothingIsNothing) {
  EXPECT_TRUE(DecomposeSymmetric(Eigen::MatrixXd(0, 0)).ok);
  EXPECT_TRUE(DecomposeSymmetric(SmallMatrix(0, 0)).ok);
  EXPECT_EQ(SymmetricEigenvalues(Eigen::MatrixXd(0, 0)).size(), 0);
}

TEST(SymmetricEigenDeathTest, RefusesWhatIsNotSquare) {
  EXPECT_DEATH(DecomposeSymmetric(Eigen::MatrixXd(Eigen::MatrixXd::Ones(3, 2))), "3 2");
  EXPECT_DEATH(DecomposeSymmetric(SmallMatrix(SmallMatrix::Ones(2, 3))), "2 3");
}

}  // namespace
}  // namespace palpate::linalg
