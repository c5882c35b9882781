// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "libs/fem/sparse/amalgamation.hpp"

namespace palpate::fem::internal {

/// An order of elimination that takes, each time, the node which adds the fewest edges for each of
/// its neighbours (minimum mean local fill: E. Rothberg, S. C. Eisenstat, Node selection strategies
/// for bottom-up sparse matrix ordering, SIAM J. Matrix Anal. Appl. 19, 1998), with the exact
/// numbers of edges, not bounds for them. Empty where the graph is too large for that to take less
/// than about a second.
std::vector<int> MinimumMeanFillOrder(const NodeGraph& graph);

}  // namespace palpate::fem::internal
