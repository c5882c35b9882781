// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/bounded_qp_step.hpp"

#include <algorithm>
#include <cmath>

#include "libs/linalg/symmetric_eigen.hpp"

namespace palpate::fem {

namespace {

using Eigen::Index;

/// Eigenvalues of a free block (diagonal 1/2..2) up to this, times its size, count as zero. The
/// products that make a Gram matrix H = G' G round to some 1e-15; a stiffer direction is data.
constexpr double kSingular = 1e-13;

/// H = L L' by rows; false at the first pivot up to `smallest`. Every pivot is an upper bound of
/// H's smallest eigenvalue, so such a block is singular for certain.
bool Factorise(const QpMatrix& H, double smallest, QpMatrix* L) {
  for (Index i = 0; i < H.rows(); ++i) {
    for (Index j = 0; j < i; ++j) {
      double sum = H(i, j);
      for (Index k = 0; k < j; ++k) sum -= (*L)(i, k) * (*L)(j, k);
      (*L)(i, j) = sum / (*L)(j, j);
    }
    double pivot = H(i, i);
    for (Index k = 0; k < i; ++k) pivot -= (*L)(i, k) * (*L)(i, k);
    if (!(pivot > smallest)) return false;
    (*L)(i, i) = std::sqrt(pivot);
  }
  return true;
}

/// Squared Frobenius norm of L^-1: the trace of H^-1, at least one over H's smallest eigenvalue.
double InverseTrace(const QpMatrix& L) {
  double trace = 0.0;
  QpVector column(L.rows());
  for (Index j = 0; j < L.rows(); ++j) {
    for (Index i = j; i < L.rows(); ++i) {
      double sum = i == j ? 1.0 : 0.0;
      for (Index k = j; k < i; ++k) sum -= L(i, k) * column[k];
      column[i] = sum / L(i, i);
      trace += column[i] * column[i];
    }
  }
  return trace;
}

/// The step -H^-1 g of a block whose smallest eigenvalue is above kSingular * size for certain;
/// false where that is undecided. Pivots alone do not decide it (Higham, Accuracy and Stability of
/// Numerical Algorithms, 2nd ed., chapter 8: a triangle with a large diagonal can be nearly
/// singular), the inverse's trace does: with it, both ways to a step agree on what is singular.
bool CholeskyStep(const FreeBlock& block, QpVector* step) {
  const Index size = block.gradient.size();
  const double smallest = kSingular * static_cast<double>(size);
  QpMatrix L(size, size);
  if (!Factorise(block.H, smallest, &L) || !(InverseTrace(L) * smallest < 1.0)) return false;
  for (Index i = 0; i < size; ++i) {
    double sum = -block.gradient[i];
    for (Index k = 0; k < i; ++k) sum -= L(i, k) * (*step)[k];
    (*step)[i] = sum / L(i, i);
  }
  for (Index i = size - 1; i >= 0; --i) {
    double sum = (*step)[i];
    for (Index k = i + 1; k < size; ++k) sum -= L(k, i) * (*step)[k];
    (*step)[i] = sum / L(i, i);
  }
  return true;
}

/// Of a block that is singular or nearly so: the smallest step to the minimum where the gradient
/// has no part in the null space, otherwise the steepest null vector, downhill. One vector at a
/// time: eigenvectors are conjugate, so that none undoes what another one has gained.
StepKind EigenStep(const FreeBlock& block, QpVector* step) {
  const Index size = block.gradient.size();
  const linalg::SmallSymmetricEigen eigen = linalg::DecomposeSymmetric(block.H);
  if (!eigen.ok) return StepKind::kFailed;
  const QpMatrix& vectors = eigen.vectors;
  Index steepest = -1;
  double steepest_slope = 0.0;
  step->setZero();
  for (Index k = 0; k < size; ++k) {
    if (eigen.values[k] > kSingular * static_cast<double>(size)) {
      *step -= vectors.col(k).dot(block.gradient) / eigen.values[k] * vectors.col(k);
      continue;
    }
    const double slope = vectors.col(k).dot(block.descent);
    const double flat = kFlatSlope * vectors.col(k).cwiseAbs().dot(block.magnitude);
    if (std::abs(slope) > std::max(flat, std::abs(steepest_slope))) {
      steepest = k;
      steepest_slope = slope;
    }
  }
  if (steepest < 0) return StepKind::kToMinimum;
  *step = std::copysign(1.0, -steepest_slope) * vectors.col(steepest);
  // What is left of rounding must not meet a bound far away.
  const double rounding = 1e-10 * step->cwiseAbs().maxCoeff();
  for (Index a = 0; a < size; ++a) {
    if (std::abs((*step)[a]) <= rounding) (*step)[a] = 0.0;
  }
  return StepKind::kRay;
}

}  // namespace

StepKind StepOf(const FreeBlock& block, QpVector* step) {
  if (CholeskyStep(block, step)) return StepKind::kToMinimum;
  return EigenStep(block, step);
}

}  // namespace palpate::fem
