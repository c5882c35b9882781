// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/LU>

#include "libs/linalg/small_matrix.hpp"

namespace palpate::linalg {

/// P A = L U of a square matrix [n x n], n may be 0 (Eigen::PartialPivLU).
class Lu {
 public:
  explicit Lu(const Eigen::MatrixXd& A);

  /// Estimate of 1 / (|A| |A^-1|), 1-norms; about 1e-16 or less where A is singular to rounding,
  /// and NaN where A is not finite. A singular matrix is not refused: ask this before Solve.
  double ReciprocalCondition() const;

  Eigen::VectorXd Solve(Eigen::VectorXd b) const;  ///< [n] x with A x = b
  Eigen::MatrixXd Solve(Eigen::MatrixXd B) const;  ///< [n x k] X with A X = B

 private:
  Eigen::PartialPivLU<Eigen::MatrixXd> factor_;
};

/// The same; allocates nothing.
class SmallLu {
 public:
  explicit SmallLu(const SmallMatrix& A);
  double ReciprocalCondition() const;
  SmallVector Solve(const SmallVector& b) const;

 private:
  Eigen::PartialPivLU<SmallMatrix> factor_;
};

}  // namespace palpate::linalg
