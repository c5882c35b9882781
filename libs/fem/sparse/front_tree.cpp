// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/sparse/front_tree.hpp"

#include <algorithm>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"

namespace palpate::fem::internal {

namespace {

long Stride(int rows) {
  constexpr int kBad = 64;
  return rows % kBad == 0 ? rows + dense::kTile : rows;
}

/// Rows of a front's panel at which the blocks of its nodes start.
class LocalRows {
 public:
  explicit LocalRows(int node_count) : row_(At(node_count), -1) {}

  void Set(const Front& front) {
    for (int k = 0; k < front.pivot_nodes; ++k) row_[At(front.first_node + k)] = 3 * k;
    int row = dense::PaddedRows(front.Pivots());
    for (const int node : front.below_nodes) {
      row_[At(node)] = row;
      row += 3;
    }
  }
  int operator[](int node) const { return row_[At(node)]; }

 private:
  std::vector<int> row_;
};

int NodeCount(const std::vector<Front>& fronts) {
  return fronts.empty() ? 0 : fronts.back().first_node + fronts.back().pivot_nodes;
}

}  // namespace

long Front::PanelStride() const {
  return Stride(dense::PaddedRows(Pivots()) + dense::PaddedRows(Below()));
}

long Front::UpdateStride() const { return Stride(dense::PaddedRows(Below())); }

double Front::MultiplyAdds() const {
  const double pivots = Pivots();
  const double below = Below();
  return pivots * pivots * pivots / 6.0 + 0.5 * pivots * pivots * below +
         0.5 * pivots * below * (below + 1.0);
}

FrontTree::FrontTree(const BlockPattern& pattern) {
  FindFronts(pattern);
  FindRows(pattern);
  FindRuns();
  FindBlocks(pattern);
}

void FrontTree::FindFronts(const BlockPattern& pattern) {
  PALPATE_CHECK(!pattern.supernode_start.empty() && pattern.supernode_start.front() == 0 &&
                    pattern.supernode_start.back() == pattern.NodeCount(),
                pattern.NodeCount());
  for (size_t s = 0; s + 1 < pattern.supernode_start.size(); ++s) {
    Front front;
    front.first_node = pattern.supernode_start[s];
    front.pivot_nodes = pattern.supernode_start[s + 1] - front.first_node;
    PALPATE_CHECK(front.pivot_nodes > 0, front.first_node);
    fronts_.push_back(std::move(front));
  }
}

/// A front's rows are those of its columns in the matrix and what its children pass on.
void FrontTree::FindRows(const BlockPattern& pattern) {
  std::vector<int> front_of_node(At(pattern.NodeCount()));
  std::vector<int> mark(At(pattern.NodeCount()), -1);
  for (int f = 0; f < static_cast<int>(fronts_.size()); ++f) {
    Front& front = fronts_[At(f)];
    const int next_node = front.first_node + front.pivot_nodes;
    const auto add = [&](int node) {
      if (node < next_node || mark[At(node)] == f) return;
      mark[At(node)] = f;
      front.below_nodes.push_back(node);
    };
    for (int node = front.first_node; node < next_node; ++node) {
      front_of_node[At(node)] = f;
      for (int k = pattern.column_start[At(node)]; k < pattern.column_start[At(node) + 1]; ++k) {
        add(pattern.row[At(k)]);
      }
    }
    for (const int child : front.children) {
      for (const int node : fronts_[At(child)].below_nodes) add(node);
    }
    std::sort(front.below_nodes.begin(), front.below_nodes.end());
    for (const int node : front.below_nodes) {
      for (int i = 0; i < 3; ++i) front.below_rows.push_back(3 * node + i);
    }
    // The parent eliminates the first of them; its front is not numbered yet.
    if (front.below_nodes.empty()) continue;
    const int first_below = front.below_nodes.front();
    const auto after = std::upper_bound(pattern.supernode_start.begin(),
                                        pattern.supernode_start.end(), first_below);
    front.parent = static_cast<int>(after - pattern.supernode_start.begin()) - 1;
    fronts_[At(front.parent)].children.push_back(f);
  }
}

void FrontTree::FindRuns() {
  LocalRows local(NodeCount(fronts_));
  for (Front& parent : fronts_) {
    local.Set(parent);
    for (const int child : parent.children) {
      Front& front = fronts_[At(child)];
      int source = 0;
      for (const int node : front.below_nodes) {
        const int target = local[node];
        const bool goes_on = !front.runs.empty() &&
                             front.runs.back().target + front.runs.back().length == target &&
                             target != dense::PaddedRows(parent.Pivots());
        if (!goes_on) front.runs.push_back({source, target, 0});
        front.runs.back().length += 3;
        source += 3;
      }
    }
  }
}

void FrontTree::FindBlocks(const BlockPattern& pattern) {
  LocalRows local(pattern.NodeCount());
  blocks_.resize(fronts_.size());
  for (size_t f = 0; f < fronts_.size(); ++f) {
    const Front& front = fronts_[f];
    local.Set(front);
    for (int k = 0; k < front.pivot_nodes; ++k) {
      const int node = front.first_node + k;
      for (int b = pattern.column_start[At(node)]; b < pattern.column_start[At(node) + 1]; ++b) {
        const long offset = 3 * k * front.PanelStride() + local[pattern.row[At(b)]];
        blocks_[f].push_back({b, static_cast<int>(offset)});
      }
    }
  }
}

}  // namespace palpate::fem::internal
