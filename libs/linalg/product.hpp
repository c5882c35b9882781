// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

namespace palpate::linalg {

using MatrixRef = Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

/// Products of large matrices by BLAS, whose kernels are those of the processor at hand; Eigen's
/// are compiled for any. Zero where the inner size is 0.
Eigen::MatrixXd Product(const MatrixRef& A, const MatrixRef& B);            ///< A B
Eigen::MatrixXd TransposedProduct(const MatrixRef& A, const MatrixRef& B);  ///< A' B
Eigen::MatrixXd Gram(const MatrixRef& A);  ///< A' A, both triangles

}  // namespace palpate::linalg
