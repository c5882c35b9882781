// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/linalg/gram.hpp"

#include "libs/linalg/lapack.hpp"

namespace palpate::linalg {

Eigen::MatrixXd Gram(const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& A) {
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(A.cols(), A.cols());
  if (A.size() == 0) return product;
  const auto n = static_cast<int>(A.cols());
  const auto m = static_cast<int>(A.rows());
  const auto stride = static_cast<int>(A.outerStride());
  const double one = 1.0;
  const double zero = 0.0;
  dsyrk_("L", "T", &n, &m, &one, A.data(), &stride, &zero, product.data(), &n);
  product.triangularView<Eigen::StrictlyUpper>() = product.transpose();
  return product;
}

}  // namespace palpate::linalg
