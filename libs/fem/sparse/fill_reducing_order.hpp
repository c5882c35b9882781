// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <span>
#include <utility>
#include <vector>

namespace palpate::fem {

/// Pairs (a, b), a != b, of nodes that some element or cable couples. Either order, repeats
/// allowed.
using NodePairs = std::vector<std::pair<int, int>>;

/// Order of elimination that keeps the Cholesky factor of a matrix with this node graph sparse
/// (the best of AMD, METIS and nested dissection), postordered. result[k] is the node eliminated
/// k-th; a permutation of 0 .. node_count - 1.
std::vector<int> FillReducingOrder(int node_count, const NodePairs& pairs);

}  // namespace palpate::fem
