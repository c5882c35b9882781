// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/linalg/lu.hpp"

#include <limits>

#include "libs/core/check.hpp"

namespace palpate::linalg {

namespace {

/// Eigen's estimate takes a norm of NaN for a well-conditioned matrix.
template <typename Factor>
double ReciprocalConditionOf(const Factor& factor) {
  if (!factor.matrixLU().allFinite()) return std::numeric_limits<double>::quiet_NaN();
  return factor.rcond();
}

}  // namespace

Lu::Lu(const Eigen::MatrixXd& A) {
  PALPATE_CHECK(A.rows() == A.cols(), A.rows(), A.cols());
  factor_.compute(A);
}

double Lu::ReciprocalCondition() const { return ReciprocalConditionOf(factor_); }

Eigen::VectorXd Lu::Solve(Eigen::VectorXd b) const {
  PALPATE_CHECK(b.rows() == factor_.rows(), b.rows(), factor_.rows());
  b = factor_.solve(b);
  return b;
}

Eigen::MatrixXd Lu::Solve(Eigen::MatrixXd B) const {
  PALPATE_CHECK(B.rows() == factor_.rows(), B.rows(), factor_.rows());
  B = factor_.solve(B);
  return B;
}

SmallLu::SmallLu(const SmallMatrix& A) {
  PALPATE_CHECK(A.rows() == A.cols(), A.rows(), A.cols());
  factor_.compute(A);
}

double SmallLu::ReciprocalCondition() const { return ReciprocalConditionOf(factor_); }

SmallVector SmallLu::Solve(const SmallVector& b) const {
  PALPATE_CHECK(b.rows() == factor_.rows(), b.rows(), factor_.rows());
  return factor_.solve(b);
}

}  // namespace palpate::linalg
