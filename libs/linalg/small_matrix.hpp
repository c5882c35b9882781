// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

namespace palpate::linalg {

/// Largest number of rows and of columns of a SmallMatrix.
inline constexpr int kMaxSmallSize = 16;

/// Vectors and matrices of variable size without heap memory, for code that must not allocate.
using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxSmallSize, 1>;
using SmallMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxSmallSize, kMaxSmallSize>;

}  // namespace palpate::linalg
