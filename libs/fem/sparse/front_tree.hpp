// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <vector>

#include "libs/fem/sparse/dense/front_kernels.hpp"
#include "libs/fem/sparse/sparse_solver.hpp"

namespace palpate::fem::internal {

/// One front of a multifrontal factorisation: nodes that are eliminated together and those further
/// down that they couple.
struct Front {
  int first_node = 0;
  int pivot_nodes = 0;
  std::vector<int> below_nodes;  ///< ascending
  int parent = -1;               ///< front, or -1
  std::vector<int> children;     ///< fronts, ascending

  std::vector<dense::Run> runs;  ///< where the update's rows lie in the parent's front
  std::vector<int> below_rows;   ///< [3 below_nodes] rows of the whole matrix

  int Pivots() const { return 3 * pivot_nodes; }
  int Below() const { return 3 * static_cast<int>(below_nodes.size()); }
  /// Distances between columns, in doubles. Not a multiple of 512 bytes, at which the columns of a
  /// tile would evict each other from the first-level cache.
  long PanelStride() const;
  long UpdateStride() const;
  size_t PanelSize() const { return static_cast<size_t>(PanelStride() * Pivots()); }
  size_t UpdateSize() const { return static_cast<size_t>(UpdateStride() * Below()); }
  double MultiplyAdds() const;
};

/// A block of the matrix and its first entry in its front's panel.
struct PanelBlock {
  int block = 0;
  int offset = 0;
};

/// The fronts of a pattern, children before parents: the symbolic analysis.
class FrontTree {
 public:
  explicit FrontTree(const BlockPattern& pattern);

  const std::vector<Front>& fronts() const { return fronts_; }
  /// Blocks of the matrix that are assembled in each front's panel.
  const std::vector<std::vector<PanelBlock>>& blocks() const { return blocks_; }

 private:
  void FindFronts(const BlockPattern& pattern);
  void FindRows(const BlockPattern& pattern);
  void FindRuns();
  void FindBlocks(const BlockPattern& pattern);

  std::vector<Front> fronts_;
  std::vector<std::vector<PanelBlock>> blocks_;
};

}  // namespace palpate::fem::internal
