// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "libs/fem/sparse/elimination_order.hpp"

namespace palpate::fem::internal {

/// Neighbours of each node, [start[a], start[a + 1]) of `neighbours`; symmetric, without repeats
/// and without the node itself.
struct NodeGraph {
  std::vector<int> start;
  std::vector<int> neighbours;
  int NodeCount() const { return static_cast<int>(start.size()) - 1; }
};

NodeGraph MakeNodeGraph(int node_count, const NodePairs& pairs);

/// What a front costs, in cycles of a core with two 512-bit multiply-add units: `pivots` nodes are
/// eliminated, `below` more take part.
double FrontCost(int pivots, int below);

struct Amalgamated {
  EliminationOrder order;
  double cost = 0.0;  ///< of one factorisation, in the unit of FrontCost
};

/// Merges the columns of the elimination tree that belongs to `nodes` (which eliminates
/// nodes[k] k-th) into supernodes and puts them in postorder.
Amalgamated Amalgamate(const NodeGraph& graph, const std::vector<int>& nodes);

}  // namespace palpate::fem::internal
