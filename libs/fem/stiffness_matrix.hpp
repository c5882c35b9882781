// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "libs/core/index.hpp"
#include "libs/fem/sparse/elimination_order.hpp"
#include "libs/fem/sparse/sparse_solver.hpp"

namespace palpate::fem {

/// Where the 3x3 block of two nodes lies in the values of a StiffnessMatrix.
struct BlockSlot {
  int address = -1;  ///< of its first entry; -1: a node is fixed, the block is not stored
  bool transposed = false;
};

/// The stiffness matrix over the free nodes, renumbered once so that its factor is sparse. Lower
/// triangle in 3x3 node blocks (BlockPattern), which solvers read as they are. Nodes with all three
/// directions fixed are left out; a node with one or two directions fixed stays, its fixed rows and
/// columns replaced by those of the identity (FixSingleDirections).
class StiffnessMatrix {
 public:
  /// `fixed` [3 x nodes]: true where a direction is fixed. `pairs`: nodes that are coupled.
  StiffnessMatrix(const Eigen::Matrix<bool, 3, Eigen::Dynamic>& fixed, const NodePairs& pairs);

  int Size() const { return 3 * free_node_count_; }                ///< rows
  int FreeIndex(int node) const { return free_index_[At(node)]; }  ///< or -1
  int NodeCount() const { return static_cast<int>(free_index_.size()); }
  BlockPattern Pattern() const { return {column_start_, row_, supernode_start_}; }
  std::span<const double> Values() const { return values_; }
  std::span<double> Values() { return values_; }

  /// The slot of block (a, b). Checks that the pair was declared.
  BlockSlot Slot(int node_a, int node_b) const;

  /// The columns of the free nodes [begin, end).
  void SetZero(int begin, int end);
  /// Adds `block` = dforce_a/dx_b at slot (a, b); for a == b it must be symmetric.
  /// `block` may be any 3x3 accessor block(row, column).
  template <typename Block>
  void Add(const BlockSlot& slot, const Block& block) {
    if (slot.address < 0) return;
    double* entry = values_.data() + slot.address;
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) *entry++ += slot.transposed ? block(c, r) : block(r, c);
    }
  }
  double MeanDiagonal() const;
  /// Adds `shift` times the mean of the diagonal to the diagonal.
  void AddRelativeShift(double shift);
  void FixSingleDirections();

  /// Nodal vector [3n] to rows of this matrix [Size()], zero in fixed directions; and back, adding.
  void Reduce(const Eigen::Ref<const Eigen::VectorXd>& nodal,
              Eigen::Ref<Eigen::VectorXd> reduced) const;
  void AddExpanded(const Eigen::Ref<const Eigen::VectorXd>& reduced, double factor,
                   Eigen::Ref<Eigen::VectorXd> nodal) const;
  /// Product with a reduced vector.
  Eigen::VectorXd Times(const Eigen::Ref<const Eigen::VectorXd>& reduced) const;

 private:
  void BuildPattern(const NodePairs& free_pairs);
  bool IsSingleFixed(int row) const { return is_single_fixed_[At(row)]; }
  const double* DiagonalBlock(int column) const {
    return values_.data() + kBlockEntries * column_start_[At(column)];
  }

  int free_node_count_ = 0;
  std::vector<int> free_index_;        ///< [nodes], place in the order of elimination, or -1
  std::vector<int> single_fixed_;      ///< reduced rows that are fixed in one direction only
  std::vector<bool> is_single_fixed_;  ///< [Size()]
  std::vector<int> column_start_;      ///< [free nodes + 1] into row_
  std::vector<int> row_;               ///< [blocks] free nodes, ascending in each column
  std::vector<int> supernode_start_;
  std::vector<double> values_;
};

}  // namespace palpate::fem
