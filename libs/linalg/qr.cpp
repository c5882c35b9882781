// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/linalg/qr.hpp"

#include <Eigen/QR>

#include "libs/core/check.hpp"

namespace palpate::linalg {

namespace {

using PivotingQr = Eigen::ColPivHouseholderQR<Eigen::MatrixXd>;

Eigen::MatrixXd BasisOf(const PivotingQr& qr) {
  return qr.householderQ() * Eigen::MatrixXd::Identity(qr.rows(), qr.rank());
}

/// Eigen's solve() also divides by pivots that rank() counts as zero, which are rounding errors. It
/// counts a pivot of NaN as zero, too.
template <typename Columns>
Columns SolveByRank(const PivotingQr& qr, const Columns& B) {
  const Eigen::Index rank = qr.rank();
  if (rank == qr.nonzeroPivots() || !qr.matrixQR().allFinite()) return qr.solve(B);
  Columns c = B;
  c.applyOnTheLeft(qr.householderQ().setLength(qr.nonzeroPivots()).adjoint());
  const auto R = qr.matrixR().topLeftCorner(rank, rank).template triangularView<Eigen::Upper>();
  Columns y = Columns::Zero(qr.cols(), B.cols());
  y.topRows(rank) = R.solve(c.topRows(rank));
  return qr.colsPermutation() * y;
}

}  // namespace

ThinQr DecomposeQr(const Eigen::MatrixXd& A) {
  PALPATE_CHECK(A.rows() >= A.cols() && A.cols() > 0, A.rows(), A.cols());
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(A);
  return {.Q = qr.householderQ() * Eigen::MatrixXd::Identity(A.rows(), A.cols()),
          .R_diagonal = qr.matrixQR().diagonal()};
}

Eigen::MatrixXd OrthonormalBasis(const Eigen::MatrixXd& A, double threshold) {
  if (A.size() == 0) return Eigen::MatrixXd(A.rows(), 0);
  PivotingQr qr(A);
  qr.setThreshold(threshold);
  return BasisOf(qr);
}

Eigen::MatrixXd OrthonormalBasis(const Eigen::MatrixXd& A) {
  if (A.size() == 0) return Eigen::MatrixXd(A.rows(), 0);
  return BasisOf(PivotingQr(A));
}

Eigen::VectorXd LeastSquares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  PALPATE_CHECK(A.rows() == b.rows() && A.size() > 0, A.rows(), A.cols(), b.rows());
  return SolveByRank(PivotingQr(A), b);
}

Eigen::MatrixXd LeastSquares(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  PALPATE_CHECK(A.rows() == B.rows() && A.size() > 0, A.rows(), A.cols(), B.rows());
  return SolveByRank(PivotingQr(A), B);
}

}  // namespace palpate::linalg
