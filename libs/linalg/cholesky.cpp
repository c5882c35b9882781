// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/linalg/cholesky.hpp"

#include <limits>

#include "libs/core/check.hpp"

namespace palpate::linalg {

namespace {

void CheckSquare(const Eigen::MatrixXd& A) {
  PALPATE_CHECK(A.rows() == A.cols(), A.rows(), A.cols());
}

void CheckRows(const Eigen::MatrixXd& A, Eigen::Index rows) {
  PALPATE_CHECK(A.rows() == rows, A.rows(), rows);
}

/// Eigen takes a pivot of NaN for positive.
template <typename Factor>
bool HasFactor(const Factor& factor) {
  return factor.info() == Eigen::Success && factor.matrixLLT().diagonal().allFinite();
}

/// Eigen takes a pivot of NaN for zero, and leaves it out.
template <typename Columns>
void SolveByLdlt(const Eigen::MatrixXd& A, Columns* columns) {
  CheckSquare(A);
  CheckRows(A, columns->rows());
  const Eigen::LDLT<Eigen::MatrixXd> factor(A);
  if (factor.vectorD().allFinite()) {
    factor.solveInPlace(*columns);
  } else {
    columns->setConstant(std::numeric_limits<double>::quiet_NaN());
  }
}

}  // namespace

Cholesky::Cholesky(const Eigen::MatrixXd& A) {
  CheckSquare(A);
  factor_.compute(A);
  ok_ = HasFactor(factor_);
}

Eigen::VectorXd Cholesky::Solve(Eigen::VectorXd b) const {
  CheckRows(factor_.matrixLLT(), b.rows());
  factor_.solveInPlace(b);
  return b;
}

Eigen::MatrixXd Cholesky::Solve(Eigen::MatrixXd B) const {
  CheckRows(factor_.matrixLLT(), B.rows());
  factor_.solveInPlace(B);
  return B;
}

Eigen::MatrixXd Cholesky::Inverse() const {
  return Solve(Eigen::MatrixXd(Eigen::MatrixXd::Identity(factor_.rows(), factor_.cols())));
}

Eigen::MatrixXd Cholesky::Lower() const { return factor_.matrixL(); }

double Cholesky::LnDeterminant() const {
  return 2.0 * factor_.matrixLLT().diagonal().array().log().sum();
}

bool InverseSpd(const SmallMatrix& A, SmallMatrix* inverse) {
  PALPATE_CHECK(A.rows() == A.cols(), A.rows(), A.cols());
  const Eigen::LLT<SmallMatrix> factor(A);
  if (!HasFactor(factor)) return false;
  inverse->setIdentity(A.rows(), A.cols());
  factor.solveInPlace(*inverse);
  return true;
}

bool SolveSpdInPlace(Eigen::MatrixXf* A, const Eigen::VectorXf& b, Eigen::VectorXf* x) {
  PALPATE_CHECK(A->rows() == A->cols() && A->rows() == b.rows(), A->rows(), A->cols(), b.rows());
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXf>> factor(*A);
  if (!HasFactor(factor)) return false;
  *x = factor.solve(b);
  return true;
}

Eigen::VectorXd SolveSymmetric(const Eigen::MatrixXd& A, Eigen::VectorXd b) {
  SolveByLdlt(A, &b);
  return b;
}

Eigen::MatrixXd SolveSymmetric(const Eigen::MatrixXd& A, Eigen::MatrixXd B) {
  SolveByLdlt(A, &B);
  return B;
}

Eigen::MatrixXd InverseSymmetric(const Eigen::MatrixXd& A) {
  return SolveSymmetric(A, Eigen::MatrixXd(Eigen::MatrixXd::Identity(A.rows(), A.cols())));
}

}  // namespace palpate::linalg
