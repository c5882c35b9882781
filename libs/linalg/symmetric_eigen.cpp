// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/linalg/symmetric_eigen.hpp"

#include <Eigen/Eigenvalues>
#include <limits>

#include "libs/core/check.hpp"

namespace palpate::linalg {

namespace {

template <typename Matrix>
Eigen::SelfAdjointEigenSolver<Matrix> Decompose(const Matrix& A, int what) {
  PALPATE_CHECK(A.rows() == A.cols(), A.rows(), A.cols());
  return Eigen::SelfAdjointEigenSolver<Matrix>(A, what);
}

template <typename Solver>
bool IsOk(const Solver& solver) {
  return solver.info() == Eigen::Success && solver.eigenvalues().allFinite();
}

}  // namespace

SymmetricEigen DecomposeSymmetric(const Eigen::MatrixXd& A) {
  if (A.size() == 0) return {.ok = true, .values = {}, .vectors = {}};
  const auto solver = Decompose(A, Eigen::ComputeEigenvectors);
  return {.ok = IsOk(solver), .values = solver.eigenvalues(), .vectors = solver.eigenvectors()};
}

SmallSymmetricEigen DecomposeSymmetric(const SmallMatrix& A) {
  if (A.size() == 0) return {.ok = true, .values = {}, .vectors = {}};
  const auto solver = Decompose(A, Eigen::ComputeEigenvectors);
  return {.ok = IsOk(solver), .values = solver.eigenvalues(), .vectors = solver.eigenvectors()};
}

Eigen::VectorXd SymmetricEigenvalues(const Eigen::MatrixXd& A) {
  if (A.size() == 0) return {};
  const auto solver = Decompose(A, Eigen::EigenvaluesOnly);
  if (IsOk(solver)) return solver.eigenvalues();
  return Eigen::VectorXd::Constant(A.rows(), std::numeric_limits<double>::quiet_NaN());
}

}  // namespace palpate::linalg
