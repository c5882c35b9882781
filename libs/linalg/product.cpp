// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/linalg/product.hpp"

#include "libs/core/check.hpp"
#include "libs/linalg/lapack.hpp"

namespace palpate::linalg {

namespace {

constexpr double kOne = 1.0;
constexpr double kZero = 0.0;

/// [rows x B.cols()] A B, or A' B where `transpose` is "T".
Eigen::MatrixXd Multiply(const char* transpose, const MatrixRef& A, const MatrixRef& B,
                         Eigen::Index rows) {
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(rows, B.cols());
  if (product.size() == 0 || B.rows() == 0) return product;
  const auto m = static_cast<int>(rows);
  const auto n = static_cast<int>(B.cols());
  const auto k = static_cast<int>(B.rows());
  const auto stride_A = static_cast<int>(A.outerStride());
  const auto stride_B = static_cast<int>(B.outerStride());
  dgemm_(transpose, "N", &m, &n, &k, &kOne, A.data(), &stride_A, B.data(), &stride_B, &kZero,
         product.data(), &m);
  return product;
}

}  // namespace

Eigen::MatrixXd Product(const MatrixRef& A, const MatrixRef& B) {
  PALPATE_CHECK(A.cols() == B.rows(), A.cols(), B.rows());
  return Multiply("N", A, B, A.rows());
}

Eigen::MatrixXd TransposedProduct(const MatrixRef& A, const MatrixRef& B) {
  PALPATE_CHECK(A.rows() == B.rows(), A.rows(), B.rows());
  return Multiply("T", A, B, A.cols());
}

Eigen::MatrixXd Gram(const MatrixRef& A) {
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(A.cols(), A.cols());
  if (A.size() == 0) return product;
  const auto n = static_cast<int>(A.cols());
  const auto k = static_cast<int>(A.rows());
  const auto stride = static_cast<int>(A.outerStride());
  dsyrk_("L", "T", &n, &k, &kOne, A.data(), &stride, &kZero, product.data(), &n);
  product.triangularView<Eigen::StrictlyUpper>() = product.transpose();
  return product;
}

}  // namespace palpate::linalg
