// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/cell_blocks.hpp"
#include "libs/fem/stiffness_matrix.hpp"

namespace palpate::fem {

/// The nodes in the order in which assembly goes over them: free nodes in the order of elimination,
/// held ones beside the first free node that they share a cell with.
struct RowOrder {
  std::vector<int> row_of_node;
  std::vector<int> node_of_row;
};

RowOrder NaturalRowOrder(int node_count);
RowOrder EliminationRowOrder(const Eigen::MatrixXi& cells, const StiffnessMatrix& stiffness);

/// What one thread assembles. It owns the rows [first_row, end_row): the forces on their nodes and
/// the block columns of the matrix that belong to them; no other thread writes there. It evaluates
/// every block of cells that has a node of it. Blocks on the border are evaluated by each of their
/// threads; each writes what it owns. So each sum has its terms in the order of the blocks, however
/// many threads there are.
struct AssemblyShare {
  /// Of one CellBlocks.
  struct OfLaw {
    std::vector<int> blocks;      ///< ascending
    std::vector<int> force_rows;  ///< [blocks][nodes][lanes]; of others: spare_row
    std::vector<int> addresses;   ///< [blocks][pairs][lanes] as of kernels::Output; or empty
    std::vector<int> own_blocks;  ///< those whose first row it owns: each is one thread's
  };
  int first_row = 0;
  int end_row = 0;
  int first_column = 0;  ///< of the matrix; without one, 0
  int end_column = 0;
  int spare_row = 0;  ///< takes forces that are never read
  std::vector<OfLaw> laws;
};

/// Rows that accumulate forces: those of the nodes, and the spare rows.
int ForceRowCount(int node_count, int threads);

/// Shares the rows out among at most `threads` threads, such that the longest list of blocks is as
/// short as it can be. Without `stiffness`, addresses stay empty.
std::vector<AssemblyShare> ShareOut(const std::vector<CellBlocks>& laws, const RowOrder& order,
                                    const StiffnessMatrix* stiffness, int threads);

}  // namespace palpate::fem
