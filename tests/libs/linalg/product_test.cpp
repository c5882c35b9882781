// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/linalg/product.hpp"

#include <gtest/gtest.h>

#include "tests/libs/linalg/random_matrix.hpp"

namespace palpate::linalg {
namespace {

constexpr double kProductRounding = 1e-12;

void ExpectNear(const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected) {
  ASSERT_EQ(found.rows(), expected.rows());
  ASSERT_EQ(found.cols(), expected.cols());
  EXPECT_LE((found - expected).norm(), kProductRounding * (1.0 + expected.norm()));
}

TEST(Product, IsThatOfEigen) {
  for (const Eigen::Index inner : {0, 1, 7, 130}) {
    const Eigen::MatrixXd A = RandomMatrix(33, inner, 1);
    const Eigen::MatrixXd B = RandomMatrix(inner, 5, 2);
    ExpectNear(Product(A, B), A * B);
    ExpectNear(TransposedProduct(A.transpose(), B), A * B);
    ExpectNear(Gram(A), A.transpose() * A);
  }
}

TEST(Product, TakesPartsOfMatrices) {
  const Eigen::MatrixXd A = RandomMatrix(40, 9, 3);
  const auto part = A.middleRows(11, 20);
  ExpectNear(Product(part.leftCols(4), A.topLeftCorner(4, 3)),
             part.leftCols(4) * A.topLeftCorner(4, 3));
  ExpectNear(TransposedProduct(part, A.middleRows(3, 20)), part.transpose() * A.middleRows(3, 20));
  ExpectNear(Gram(part), part.transpose() * part);
}

TEST(Product, OfNothingHasTheRightSize) {
  ExpectNear(Product(Eigen::MatrixXd(0, 3), Eigen::MatrixXd::Ones(3, 2)), Eigen::MatrixXd(0, 2));
  ExpectNear(Gram(Eigen::MatrixXd(0, 3)), Eigen::MatrixXd::Zero(3, 3));
}

TEST(ProductDeathTest, RefusesWhatDoesNotFit) {
  EXPECT_DEATH(Product(Eigen::MatrixXd::Ones(2, 3), Eigen::MatrixXd::Ones(2, 3)), "3 2");
  EXPECT_DEATH(TransposedProduct(Eigen::MatrixXd::Ones(2, 3), Eigen::MatrixXd::Ones(3, 3)), "2 3");
}

}  // namespace
}  // namespace palpate::linalg
