// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

namespace palpate::linalg {

/// A = U diag(values) V' of a matrix [m x n], k = min(m, n), which may be 0.
struct ThinSvd {
  Eigen::MatrixXd U;       ///< [m x k] orthonormal columns
  Eigen::VectorXd values;  ///< [k] not negative, descending
  Eigen::MatrixXd V;       ///< [n x k] orthonormal columns
};

/// The part of it that the columns of A span.
struct LeftSvd {
  Eigen::MatrixXd U;
  Eigen::VectorXd values;
};

/// Eigen::BDCSVD. What comes of a matrix that is not finite is without meaning.
ThinSvd DecomposeSvd(const Eigen::MatrixXd& A);

/// Eigen::JacobiSVD after a QR decomposition without pivoting: faster for m much larger than n, and
/// less exact in values that are small beside the largest.
LeftSvd DecomposeTall(const Eigen::MatrixXd& A);

/// [k] descending; Eigen::JacobiSVD.
Eigen::VectorXd SingularValues(const Eigen::MatrixXd& A);

}  // namespace palpate::linalg
