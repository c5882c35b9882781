// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/sparse/amalgamation.hpp"

#include <algorithm>
#include <numeric>

#include "libs/core/index.hpp"
#include "libs/fem/sparse/dense/front_kernels.hpp"

namespace palpate::fem::internal {

namespace {

/// Parent of each place in the elimination tree, or -1 (Liu, "The role of elimination trees in
/// sparse factorization", SIAM J. Matrix Anal. 1990, algorithm 4.2).
std::vector<int> EliminationTree(const NodeGraph& graph, const std::vector<int>& nodes,
                                 const std::vector<int>& place) {
  std::vector<int> parent(nodes.size(), -1);
  std::vector<int> ancestor(nodes.size(), -1);
  for (int k = 0; k < static_cast<int>(nodes.size()); ++k) {
    const int node = nodes[At(k)];
    for (int e = graph.start[At(node)]; e < graph.start[At(node) + 1]; ++e) {
      int j = place[At(graph.neighbours[At(e)])];
      while (j < k && ancestor[At(j)] != k) {
        const int next = ancestor[At(j)];
        ancestor[At(j)] = k;
        if (next < 0) {
          parent[At(j)] = k;
          break;
        }
        j = next;
      }
    }
  }
  return parent;
}

/// Places below the diagonal in each column of the factor.
std::vector<int> ColumnCounts(const NodeGraph& graph, const std::vector<int>& nodes,
                              const std::vector<int>& place, const std::vector<int>& parent) {
  // Each row's entries are the paths from its neighbours up to the row itself.
  std::vector<int> count(nodes.size(), 0);
  std::vector<int> mark(nodes.size(), -1);
  for (int k = 0; k < static_cast<int>(nodes.size()); ++k) {
    mark[At(k)] = k;
    const int node = nodes[At(k)];
    for (int e = graph.start[At(node)]; e < graph.start[At(node) + 1]; ++e) {
      for (int j = place[At(graph.neighbours[At(e)])]; j < k && mark[At(j)] != k;
           j = parent[At(j)]) {
        ++count[At(j)];
        mark[At(j)] = k;
      }
    }
  }
  return count;
}

/// A supernode while it grows: the column that it is named after is its last.
struct Supernode {
  std::vector<int> places;
  std::vector<int> children;
  int below = 0;
};

/// Adding a child's update to its parent, per entry.
double AddingCost(int below) {
  const double rows = 3.0 * below;
  return 0.5 * 0.6 * rows * rows + 6.0 * rows;
}

double MergingGain(const Supernode& child, const Supernode& parent) {
  const int child_pivots = static_cast<int>(child.places.size());
  const int pivots = static_cast<int>(parent.places.size());
  return FrontCost(child_pivots, child.below) + AddingCost(child.below) +
         FrontCost(pivots, parent.below) - FrontCost(child_pivots + pivots, parent.below);
}

void Merge(Supernode* child, Supernode* parent) {
  parent->places.insert(parent->places.begin(), child->places.begin(), child->places.end());
  parent->children.insert(parent->children.end(), child->children.begin(), child->children.end());
  child->places = {};
  child->children = {};
}

/// Takes in the children that are worth it, the most worthwhile first.
void MergeChildren(int name, std::vector<Supernode>* supernodes) {
  Supernode& parent = (*supernodes)[At(name)];
  for (;;) {
    double best_gain = 0.0;
    size_t best = parent.children.size();
    for (size_t k = 0; k < parent.children.size(); ++k) {
      const double gain = MergingGain((*supernodes)[At(parent.children[k])], parent);
      if (gain > best_gain) {
        best_gain = gain;
        best = k;
      }
    }
    if (best == parent.children.size()) return;
    const int child = parent.children[best];
    parent.children.erase(parent.children.begin() + static_cast<long>(best));
    Merge(&(*supernodes)[At(child)], &parent);
  }
}

/// Appends the subtrees of `roots` in postorder; the largest child comes last, next to its parent.
void AppendPostorder(const std::vector<Supernode>& supernodes, std::vector<int> roots,
                     const std::vector<int>& nodes, EliminationOrder* order) {
  struct Visit {
    int name;
    bool children_done;
  };
  std::vector<Visit> stack;
  const auto push = [&](std::vector<int> names) {
    std::sort(names.begin(), names.end(), [&](int a, int b) {
      const int below_a = supernodes[At(a)].below;
      const int below_b = supernodes[At(b)].below;
      return below_a != below_b ? below_a > below_b : a > b;
    });
    for (const int name : names) stack.push_back({name, false});
  };
  push(std::move(roots));
  while (!stack.empty()) {
    Visit& visit = stack.back();
    const Supernode& supernode = supernodes[At(visit.name)];
    if (!visit.children_done) {
      visit.children_done = true;
      push(supernode.children);
      continue;
    }
    stack.pop_back();
    for (const int place : supernode.places) order->nodes.push_back(nodes[At(place)]);
    order->supernode_start.push_back(static_cast<int>(order->nodes.size()));
  }
}

}  // namespace

NodeGraph MakeNodeGraph(int node_count, const NodePairs& pairs) {
  NodePairs both;
  both.reserve(2 * pairs.size());
  for (const auto& [a, b] : pairs) {
    both.emplace_back(a, b);
    both.emplace_back(b, a);
  }
  std::sort(both.begin(), both.end());
  both.erase(std::unique(both.begin(), both.end()), both.end());
  NodeGraph graph;
  graph.start.assign(At(node_count) + 1, 0);
  graph.neighbours.reserve(both.size());
  for (const auto& [a, b] : both) {
    if (a == b) continue;
    ++graph.start[At(a) + 1];
    graph.neighbours.push_back(b);
  }
  std::partial_sum(graph.start.begin(), graph.start.end(), graph.start.begin());
  return graph;
}

double FrontCost(int pivots, int below) {
  constexpr double kPerFront = 500.0;
  constexpr double kPerPivotRow = 60.0;  // the square root and what waits for it
  constexpr double kMultiplyAddsPerCycle = 11.0;
  constexpr double kPerEntry = 4.0;  // zeroing, storing, and the substitutions of one frame
  const double K = 3.0 * pivots;
  const double rows = dense::PaddedRows(3 * below);
  const double multiply_adds = K * K * K / 6.0 + 0.5 * K * K * rows + 0.5 * K * rows * (rows + 8);
  return kPerFront + kPerPivotRow * K + multiply_adds / kMultiplyAddsPerCycle +
         kPerEntry * K * (0.5 * K + rows) + 0.1 * rows * rows;
}

Amalgamated Amalgamate(const NodeGraph& graph, const std::vector<int>& nodes) {
  std::vector<int> place(nodes.size());
  for (size_t k = 0; k < nodes.size(); ++k) place[At(nodes[k])] = static_cast<int>(k);
  const std::vector<int> parent = EliminationTree(graph, nodes, place);
  const std::vector<int> count = ColumnCounts(graph, nodes, place, parent);

  std::vector<Supernode> supernodes(nodes.size());
  std::vector<int> roots;
  for (int k = 0; k < static_cast<int>(nodes.size()); ++k) {
    Supernode& supernode = supernodes[At(k)];
    supernode.places = {k};
    supernode.below = count[At(k)];
    MergeChildren(k, &supernodes);
    if (parent[At(k)] >= 0) {
      supernodes[At(parent[At(k)])].children.push_back(k);
    } else {
      roots.push_back(k);
    }
  }
  Amalgamated result;
  result.order.supernode_start.push_back(0);
  for (const Supernode& supernode : supernodes) {
    if (supernode.places.empty()) continue;
    result.cost += FrontCost(static_cast<int>(supernode.places.size()), supernode.below) +
                   AddingCost(supernode.below);
  }
  AppendPostorder(supernodes, roots, nodes, &result.order);
  return result;
}

}  // namespace palpate::fem::internal
