// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "libs/linalg/small_matrix.hpp"

namespace palpate::linalg {

/// A = vectors * diag(values) * vectors' of a symmetric matrix [n x n].
struct SymmetricEigen {
  bool ok = false;          ///< false where A is not finite or the iteration did not converge
  Eigen::VectorXd values;   ///< [n] ascending
  Eigen::MatrixXd vectors;  ///< [n x n] orthonormal columns
};

struct SmallSymmetricEigen {
  bool ok = false;
  SmallVector values;
  SmallMatrix vectors;
};

/// Eigen::SelfAdjointEigenSolver. Only the lower triangle of A is read; n may be 0.
SymmetricEigen DecomposeSymmetric(const Eigen::MatrixXd& A);

/// The same; allocates nothing.
SmallSymmetricEigen DecomposeSymmetric(const SmallMatrix& A);

/// [n] ascending; NaN where DecomposeSymmetric would not be ok.
Eigen::VectorXd SymmetricEigenvalues(const Eigen::MatrixXd& A);

}  // namespace palpate::linalg
