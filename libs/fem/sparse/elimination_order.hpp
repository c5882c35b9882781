// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <utility>
#include <vector>

namespace palpate::fem {

/// Pairs (a, b), a != b, of nodes that some element or cable couples. Either order, repeats
/// allowed.
using NodePairs = std::vector<std::pair<int, int>>;

/// An order in which the nodes of a symmetric matrix are eliminated so that its factor stays
/// sparse, and which of them are eliminated together.
struct EliminationOrder {
  std::vector<int> nodes;  ///< nodes[k] is eliminated k-th; a permutation of 0 .. n - 1
  /// Supernode s holds the places [supernode_start[s], supernode_start[s + 1]). Postordered:
  /// children come before their parents.
  std::vector<int> supernode_start;
};

/// The best of AMD, METIS and nested dissection (through CHOLMOD, on the node graph) and minimum
/// local fill, with supernodes merged as long as the time that a factorisation and its
/// substitutions are expected to take falls.
EliminationOrder FindEliminationOrder(int node_count, const NodePairs& pairs);

}  // namespace palpate::fem
