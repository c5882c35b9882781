// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/assembly_shares.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

#include "libs/core/index.hpp"

namespace palpate::fem {

namespace {

using kernels::kLanes;

/// Spare rows of different threads lie in different cache lines.
constexpr int kSpareRowsPerThread = 4;

/// The rows of each block's cells, ascending; blocks of all laws one after another.
std::vector<std::vector<int>> RowsOfBlocks(const std::vector<CellBlocks>& laws,
                                           const RowOrder& order) {
  std::vector<std::vector<int>> rows_of_block;
  for (const CellBlocks& law : laws) {
    for (int block = 0; block < law.BlockCount(); ++block) {
      std::vector<int>& rows = rows_of_block.emplace_back();
      for (int lane = 0; lane < kLanes; ++lane) {
        if (law.CellAt(block, lane) < 0) continue;
        for (int a = 0; a < law.NodesPerCell(); ++a) {
          rows.push_back(order.row_of_node[At(law.NodeAt(block, a, lane))]);
        }
      }
      std::sort(rows.begin(), rows.end());
      rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    }
  }
  return rows_of_block;
}

/// First rows of consecutive shares, each of which touches at most `limit` blocks (or has one row).
std::vector<int> CutRows(const std::vector<std::vector<int>>& blocks_of_row, size_t block_count,
                         int limit) {
  std::vector<int> cuts{0};
  std::vector<int> counted_in_share(block_count, -1);
  int count = 0;
  for (int row = 0; row < static_cast<int>(blocks_of_row.size()); ++row) {
    const auto mark_blocks = [&] {
      int new_blocks = 0;
      for (const int block : blocks_of_row[At(row)]) {
        const auto share = static_cast<int>(cuts.size());
        if (counted_in_share[At(block)] != share) ++new_blocks;
        counted_in_share[At(block)] = share;
      }
      return new_blocks;
    };
    count += mark_blocks();
    if (count > limit && cuts.back() < row) {
      cuts.push_back(row);
      count = mark_blocks();
    }
  }
  return cuts;
}

/// First rows of at most `threads` shares, the longest as short as can be, and the end.
std::vector<int> BalancedCuts(const std::vector<std::vector<int>>& rows_of_block, int rows,
                              int threads) {
  std::vector<std::vector<int>> blocks_of_row(At(rows));
  for (size_t block = 0; block < rows_of_block.size(); ++block) {
    for (const int row : rows_of_block[block]) {
      blocks_of_row[At(row)].push_back(static_cast<int>(block));
    }
  }
  int too_short = 0;
  auto long_enough = static_cast<int>(rows_of_block.size());
  while (threads > 1 && long_enough - too_short > 1) {
    const int limit = std::midpoint(too_short, long_enough);
    const bool fits = CutRows(blocks_of_row, rows_of_block.size(), limit).size() <= At(threads);
    (fits ? long_enough : too_short) = limit;
  }
  std::vector<int> cuts = CutRows(blocks_of_row, rows_of_block.size(), long_enough);
  cuts.push_back(rows);
  return cuts;
}

/// Appends one block to what its law's share lists.
void AppendBlock(const CellBlocks& law, int block, const RowOrder& order,
                 const StiffnessMatrix* stiffness, const AssemblyShare& share,
                 AssemblyShare::OfLaw* of_law) {
  const auto is_own = [&](int row) { return share.first_row <= row && row < share.end_row; };
  const auto row_at = [&](int a, int lane) {
    return order.row_of_node[At(law.NodeAt(block, a, lane))];
  };
  of_law->blocks.push_back(block);
  for (int a = 0; a < law.NodesPerCell(); ++a) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const bool writes = law.CellAt(block, lane) >= 0 && is_own(row_at(a, lane));
      of_law->force_rows.push_back(writes ? row_at(a, lane) : share.spare_row);
    }
  }
  if (stiffness == nullptr) return;
  for (int b = 0; b < law.NodesPerCell(); ++b) {
    for (int a = b; a < law.NodesPerCell(); ++a) {
      for (int lane = 0; lane < kLanes; ++lane) {
        const bool writes = law.CellAt(block, lane) >= 0 && is_own(row_at(b, lane));
        of_law->addresses.push_back(
            writes ? stiffness->Slot(law.NodeAt(block, a, lane), law.NodeAt(block, b, lane)).address
                   : -1);
      }
    }
  }
}

/// Those of its rows that are columns of the matrix, too.
int FreeRows(const RowOrder& order, const StiffnessMatrix& stiffness, const AssemblyShare& share) {
  const auto first = order.node_of_row.begin();
  return static_cast<int>(std::count_if(first + share.first_row, first + share.end_row,
                                        [&](int node) { return stiffness.FreeIndex(node) >= 0; }));
}

}  // namespace

RowOrder NaturalRowOrder(int node_count) {
  RowOrder order;
  order.node_of_row.resize(At(node_count));
  std::iota(order.node_of_row.begin(), order.node_of_row.end(), 0);
  order.row_of_node = order.node_of_row;
  return order;
}

RowOrder EliminationRowOrder(const Eigen::MatrixXi& cells, const StiffnessMatrix& stiffness) {
  RowOrder order = NaturalRowOrder(stiffness.NodeCount());
  constexpr int kNone = std::numeric_limits<int>::max();
  std::vector<int> place(order.row_of_node.size(), kNone);
  for (Eigen::Index cell = 0; cell < cells.cols(); ++cell) {
    int first_free = kNone;
    for (const int node : cells.col(cell)) {
      if (stiffness.FreeIndex(node) >= 0) {
        first_free = std::min(first_free, stiffness.FreeIndex(node));
      }
    }
    for (const int node : cells.col(cell)) place[At(node)] = std::min(place[At(node)], first_free);
  }
  const auto key = [&](int node) {
    const int free_index = stiffness.FreeIndex(node);
    const bool held = free_index < 0;
    return std::make_tuple(held ? place[At(node)] : free_index, held, node);
  };
  std::sort(order.node_of_row.begin(), order.node_of_row.end(),
            [&](int a, int b) { return key(a) < key(b); });
  for (size_t row = 0; row < order.node_of_row.size(); ++row) {
    order.row_of_node[At(order.node_of_row[row])] = static_cast<int>(row);
  }
  return order;
}

int ForceRowCount(int node_count, int threads) {
  return node_count + threads * kSpareRowsPerThread;
}

std::vector<AssemblyShare> ShareOut(const std::vector<CellBlocks>& laws, const RowOrder& order,
                                    const StiffnessMatrix* stiffness, int threads) {
  const auto rows = static_cast<int>(order.node_of_row.size());
  const std::vector<std::vector<int>> rows_of_block = RowsOfBlocks(laws, order);
  const std::vector<int> cuts = BalancedCuts(rows_of_block, rows, threads);
  std::vector<AssemblyShare> shares;
  for (size_t thread = 0; thread + 1 < cuts.size(); ++thread) {
    AssemblyShare& share = shares.emplace_back();
    share.first_row = cuts[thread];
    share.end_row = cuts[thread + 1];
    if (stiffness != nullptr) {
      share.first_column = shares.size() > 1 ? shares[shares.size() - 2].end_column : 0;
      share.end_column = share.first_column + FreeRows(order, *stiffness, share);
    }
    share.spare_row = rows + static_cast<int>(thread) * kSpareRowsPerThread;
    size_t first_block = 0;
    for (const CellBlocks& law : laws) {
      AssemblyShare::OfLaw& of_law = share.laws.emplace_back();
      for (int block = 0; block < law.BlockCount(); ++block) {
        const std::vector<int>& touched = rows_of_block[first_block + At(block)];
        const auto first_touched =
            std::lower_bound(touched.begin(), touched.end(), share.first_row);
        if (first_touched == touched.end() || *first_touched >= share.end_row) continue;
        AppendBlock(law, block, order, stiffness, share, &of_law);
        if (first_touched == touched.begin()) of_law.own_blocks.push_back(block);
      }
      first_block += At(law.BlockCount());
    }
  }
  return shares;
}

}  // namespace palpate::fem
