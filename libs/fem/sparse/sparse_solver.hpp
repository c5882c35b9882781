// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "libs/core/status.hpp"

namespace palpate::fem {

/// A symmetric matrix by its lower triangle, columns compressed, rows ascending, with the diagonal.
/// The rows and columns are already in a fill-reducing order: solvers keep it.
struct SymmetricPattern {
  std::span<const int> column_start;  ///< [n + 1]
  std::span<const int> row;           ///< [nonzeros]
  int Size() const { return static_cast<int>(column_start.size()) - 1; }
};

/// Direct solver for symmetric positive definite matrices of one pattern: analysed once, factorised
/// again and again. After the first factorisation nothing is allocated on the heap.
class SparseSolver {
 public:
  virtual ~SparseSolver() = default;

  /// `values` in the order of `pattern.row`. Not ok, and no factor, where the matrix is not
  /// positive definite (kNotPositiveDefinite) or holds NaN.
  virtual Status Factorize(std::span<const double> values) = 0;

  /// Overwrites each column of `columns` [n x m] with the solution. Needs a factor.
  virtual void Solve(Eigen::Ref<Eigen::MatrixXd> columns) = 0;

  virtual std::string Name() const = 0;
  /// Nonzeros of the factor and the bytes it holds.
  virtual size_t FactorNonzeros() const = 0;
  virtual size_t MemoryBytes() const = 0;
  /// Floating-point operations of one factorisation.
  virtual double FactorFlops() const = 0;
};

/// CHOLMOD's supernodal Cholesky, analysed for `pattern`, which must outlive the solver.
std::unique_ptr<SparseSolver> MakeCholmodSolver(const SymmetricPattern& pattern);

}  // namespace palpate::fem
