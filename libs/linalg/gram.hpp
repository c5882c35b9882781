// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

namespace palpate::linalg {

/// A' A [n x n] of A [m x n], both triangles, by BLAS (dsyrk); zero where m is 0.
Eigen::MatrixXd Gram(const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& A);

}  // namespace palpate::linalg
