// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/linalg/cholesky.hpp"

#include <limits>

#include "libs/core/check.hpp"
#include "libs/linalg/lapack.hpp"

namespace palpate::linalg {

namespace {

/// From this size on LAPACK is faster than Eigen, which is compiled for any processor.
constexpr Eigen::Index kLarge = 64;

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

/// b becomes x with L L' x = b.
template <typename Columns>
void SolveByEigen(const Eigen::MatrixXd& L, Columns* columns) {
  L.triangularView<Eigen::Lower>().solveInPlace(*columns);
  L.triangularView<Eigen::Lower>().transpose().solveInPlace(*columns);
}

}  // namespace

Cholesky::Cholesky(const Eigen::MatrixXd& A) : L_(A) {
  CheckSquare(A);
  if (L_.rows() < kLarge) {
    ok_ = HasFactor(Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>>(L_));
    return;
  }
  const auto n = static_cast<int>(L_.rows());
  int info = 0;
  dpotrf_("L", &n, L_.data(), &n, &info);
  ok_ = info == 0 && L_.diagonal().allFinite();
}

Eigen::VectorXd Cholesky::Solve(Eigen::VectorXd b) const {
  CheckRows(L_, b.rows());
  SolveByEigen(L_, &b);
  return b;
}

Eigen::MatrixXd Cholesky::Solve(Eigen::MatrixXd B) const {
  CheckRows(L_, B.rows());
  if (L_.rows() < kLarge) {
    SolveByEigen(L_, &B);
    return B;
  }
  const auto n = static_cast<int>(L_.rows());
  const auto columns = static_cast<int>(B.cols());
  int info = 0;
  dpotrs_("L", &n, &columns, L_.data(), &n, B.data(), &n, &info);
  return B;
}

Eigen::MatrixXd Cholesky::Inverse() const {
  if (L_.rows() < kLarge) {
    return Solve(Eigen::MatrixXd(Eigen::MatrixXd::Identity(L_.rows(), L_.cols())));
  }
  Eigen::MatrixXd inverse = L_;
  const auto n = static_cast<int>(L_.rows());
  int info = 0;
  dpotri_("L", &n, inverse.data(), &n, &info);
  inverse.triangularView<Eigen::StrictlyUpper>() = inverse.transpose();
  return inverse;
}

Eigen::MatrixXd Cholesky::Lower() const { return L_.triangularView<Eigen::Lower>(); }

double Cholesky::LnDeterminant() const { return 2.0 * L_.diagonal().array().log().sum(); }

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
