// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "libs/core/instruction_set.hpp"
#include "libs/core/status.hpp"
#include "libs/core/thread_team.hpp"

namespace palpate::fem {

/// A symmetric matrix of 3x3 blocks, one block row for each node, by its lower triangle: block
/// columns compressed, block rows ascending, the diagonal block first. The nodes are already in a
/// fill-reducing order: solvers keep it.
struct BlockPattern {
  std::span<const int> column_start;  ///< [nodes + 1] into `row`
  std::span<const int> row;           ///< [blocks]
  /// [supernodes + 1] Nodes that are worth being eliminated together; see elimination_order.hpp.
  std::span<const int> supernode_start;
  int NodeCount() const { return static_cast<int>(column_start.size()) - 1; }
  int Size() const { return 3 * NodeCount(); }
};

/// Values of one block, column after column: entry (r, c) is the (3 c + r)-th. Of diagonal blocks
/// only the lower triangle is read.
inline constexpr int kBlockEntries = 9;

/// Direct solver for symmetric positive definite matrices of one pattern: analysed once, factorised
/// again and again. After the first factorisation nothing is allocated on the heap.
class SparseSolver {
 public:
  virtual ~SparseSolver() = default;

  /// `values` [blocks][kBlockEntries] in the order of `pattern.row`. Not ok, and no factor, where
  /// the matrix is not positive definite (kNotPositiveDefinite) or holds NaN.
  virtual Status Factorize(std::span<const double> values) = 0;

  /// Overwrites each column of `columns` [n x m] with the solution. Needs a factor.
  virtual void Solve(Eigen::Ref<Eigen::MatrixXd> columns) = 0;

  /// From the next factorisation on the factor is kept in single precision, too, where the solver
  /// can: half as much again to store, and to hold.
  virtual void KeepSinglePrecision() {}
  /// Solve by the rounded factor where there is one: with a relative error of some 1e-7 times the
  /// condition, for steps that the next residual corrects. Reads half the memory, which is what the
  /// time of few columns goes with.
  virtual void SolveSingle(Eigen::Ref<Eigen::MatrixXd> columns) { Solve(columns); }

  virtual std::string Name() const = 0;
  /// Nonzeros of the factor and the bytes it holds.
  virtual size_t FactorNonzeros() const = 0;
  virtual size_t MemoryBytes() const = 0;
  /// Floating-point operations of one factorisation.
  virtual double FactorFlops() const = 0;
};

/// Multifrontal Cholesky with a fixed pattern, on the threads of `team`, which must outlive the
/// solver; the inner loops are those of `instruction_set`. The factor does not depend on the number
/// of threads.
std::unique_ptr<SparseSolver> MakeMultifrontalSolver(
    const BlockPattern& pattern, ThreadTeam& team,
    InstructionSet instruction_set = BestInstructionSet());

enum class CholmodMethod { kSupernodal, kSimplicial };

/// CHOLMOD's Cholesky: the reference, and what to fall back upon. Runs on the calling thread.
std::unique_ptr<SparseSolver> MakeCholmodSolver(const BlockPattern& pattern,
                                                CholmodMethod method = CholmodMethod::kSupernodal);

}  // namespace palpate::fem
