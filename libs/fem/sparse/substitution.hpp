// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "libs/core/thread_team.hpp"
#include "libs/fem/sparse/aligned_buffer.hpp"
#include "libs/fem/sparse/dense/front_kernels.hpp"
#include "libs/fem/sparse/factor_store.hpp"
#include "libs/fem/sparse/front_schedule.hpp"
#include "libs/fem/sparse/front_tree.hpp"
#include "libs/fem/sparse/substitution_plan.hpp"

namespace palpate::fem::internal {

/// Forward and backward substitution through the fronts of a factor, on the threads of a team.
class Substitution {
 public:
  /// All must outlive this. `size`: rows of the matrix.
  Substitution(const FrontTree& tree, const FrontSchedule& schedule,
               const dense::FrontKernels& kernels, ThreadTeam& team, FactorStore& factor, int size);

  /// Overwrites each column [size] with its solution; `rounded`: by the rounded factor.
  void Solve(Eigen::Ref<Eigen::MatrixXd> columns, bool rounded);

  size_t Bytes() const { return rows_.bytes(); }

 private:
  /// Columns [first, first + count) of the right-hand sides while they are worked on.
  struct Block {
    double* rows = nullptr;  ///< [..][width], zeros behind the count
    int first = 0;
    int count = 0;
    int width = 0;  ///< 1, or a multiple of kTile
    bool rounded = false;
  };

  void SolveBlocks(Eigen::Ref<Eigen::MatrixXd> columns, bool rounded);
  void SolveShared(std::span<const Block> blocks, Eigen::Ref<Eigen::MatrixXd> columns);
  void Read(int f, const Block& block, const Eigen::Ref<const Eigen::MatrixXd>& columns) const;
  void Write(int f, const Block& block, Eigen::Ref<Eigen::MatrixXd> columns) const;
  void AddShares(const Block& block) const;
  bool IsZero(int f, const Block& block) const;
  void Forward(int f, const Block& block);
  void Backward(int f, const Block& block, int thread);
  template <typename Value>
  void Forward(const dense::SubstitutionKernelsOf<Value>& kernels,
               const dense::FactorPanelOf<Value>& factor, int f, const Block& block);
  template <typename Value>
  void Backward(const dense::SubstitutionKernelsOf<Value>& kernels,
                const dense::FactorPanelOf<Value>& factor, int f, const Block& block, int thread);

  const FrontTree& tree_;
  const FrontSchedule& schedule_;
  const dense::FrontKernels& kernels_;
  ThreadTeam& team_;
  FactorStore& factor_;
  SubstitutionPlan plan_;
  int size_;
  /// Right-hand sides, block after block, in each row after row: those of the matrix, then each
  /// thread's share.
  AlignedBuffer rows_;
  long block_rows_;
  std::vector<AlignedBuffer> sums_;  ///< [threads] of a single column, of each pivot of a front
};

}  // namespace palpate::fem::internal
