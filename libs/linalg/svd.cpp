// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/linalg/svd.hpp"

#include <Eigen/SVD>

namespace palpate::linalg {

namespace {

Eigen::MatrixXd Empty(Eigen::Index rows) { return Eigen::MatrixXd(rows, 0); }

}  // namespace

ThinSvd DecomposeSvd(const Eigen::MatrixXd& A) {
  if (A.size() == 0) return {.U = Empty(A.rows()), .values = {}, .V = Empty(A.cols())};
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(A, Eigen::ComputeThinU | Eigen::ComputeThinV);
  return {.U = svd.matrixU(), .values = svd.singularValues(), .V = svd.matrixV()};
}

LeftSvd DecomposeTall(const Eigen::MatrixXd& A) {
  if (A.size() == 0) return {.U = Empty(A.rows()), .values = {}};
  const Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::HouseholderQRPreconditioner> svd(
      A, Eigen::ComputeThinU);
  return {.U = svd.matrixU(), .values = svd.singularValues()};
}

Eigen::VectorXd SingularValues(const Eigen::MatrixXd& A) {
  if (A.size() == 0) return {};
  return Eigen::JacobiSVD<Eigen::MatrixXd>(A).singularValues();
}

}  // namespace palpate::linalg
