// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

namespace palpate::linalg {

/// A = Q R of a matrix [m x n] with m >= n >= 1, without pivoting (Eigen::HouseholderQR).
struct ThinQr {
  Eigen::MatrixXd Q;           ///< [m x n] orthonormal columns
  Eigen::VectorXd R_diagonal;  ///< [n] of either sign; 0 where a column depends on those before it
};

ThinQr DecomposeQr(const Eigen::MatrixXd& A);

/// [m x rank] orthonormal basis of the column space of A [m x n] (Eigen::ColPivHouseholderQR). The
/// rank counts the pivots above `threshold` times the largest; m x 0 of zeros or of no columns.
Eigen::MatrixXd OrthonormalBasis(const Eigen::MatrixXd& A, double threshold);
/// With a threshold of min(m, n) times the precision of a double.
Eigen::MatrixXd OrthonormalBasis(const Eigen::MatrixXd& A);

/// The x that minimises |A x - b|, A [m x n] not empty (Eigen::ColPivHouseholderQR). Where A has
/// not full column rank to rounding, unknowns that depend on others are zero. NaN in, NaN out.
Eigen::VectorXd LeastSquares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
/// [n x k] the same of each column of B [m x k].
Eigen::MatrixXd LeastSquares(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

}  // namespace palpate::linalg
