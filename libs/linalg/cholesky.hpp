// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Cholesky>

#include "libs/linalg/small_matrix.hpp"

namespace palpate::linalg {

/// A = L L' of a symmetric positive definite matrix (Eigen::LLT; LAPACK's where it is large). Only
/// the lower triangle is read.
class Cholesky {
 public:
  explicit Cholesky(const Eigen::MatrixXd& A);  ///< [n x n], n may be 0

  /// False where A is not positive definite to rounding, or not finite. Everything below is then
  /// without meaning.
  bool ok() const { return ok_; }

  Eigen::VectorXd Solve(Eigen::VectorXd b) const;  ///< [n] x with A x = b
  Eigen::MatrixXd Solve(Eigen::MatrixXd B) const;  ///< [n x k] X with A X = B
  Eigen::MatrixXd Inverse() const;                 ///< [n x n]
  Eigen::MatrixXd Lower() const;                   ///< [n x n] L
  double LnDeterminant() const;                    ///< ln det A

 private:
  Eigen::MatrixXd L_;  ///< lower triangle
  bool ok_;
};

/// The inverse of a symmetric positive definite matrix [n x n]; allocates nothing. False where
/// Cholesky would not be ok: `inverse` then stays as it was.
[[nodiscard]] bool InverseSpd(const SmallMatrix& A, SmallMatrix* inverse);

/// Solves A x = b in single precision, A symmetric positive definite, its lower triangle read and
/// overwritten. False where Cholesky would not be ok: `x` then stays as it was.
[[nodiscard]] bool SolveSpdInPlace(Eigen::MatrixXf* A, const Eigen::VectorXf& b,
                                   Eigen::VectorXf* x);

/// x with A x = b of a symmetric matrix [n x n] that is positive or negative semidefinite
/// (Eigen::LDLT, with pivoting). Only the lower triangle is read. What A maps to zero gets no part
/// in x; it is not a failure. NaN in, NaN out.
Eigen::VectorXd SolveSymmetric(const Eigen::MatrixXd& A, Eigen::VectorXd b);
Eigen::MatrixXd SolveSymmetric(const Eigen::MatrixXd& A, Eigen::MatrixXd B);  ///< [n x k]
Eigen::MatrixXd InverseSymmetric(const Eigen::MatrixXd& A);                   ///< [n x n]

}  // namespace palpate::linalg
