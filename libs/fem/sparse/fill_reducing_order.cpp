// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/sparse/fill_reducing_order.hpp"

#include <algorithm>

#include "libs/core/check.hpp"
#include "libs/fem/sparse/cholmod_context.hpp"

namespace palpate::fem {

namespace {

/// The graph as the pattern of a lower triangle with its diagonal.
cholmod_sparse* MakeGraph(int node_count, const NodePairs& pairs, cholmod_common* common) {
  NodePairs lower;  // (column, row)
  lower.reserve(pairs.size() + static_cast<size_t>(node_count));
  for (const auto& [a, b] : pairs) lower.emplace_back(std::min(a, b), std::max(a, b));
  for (int node = 0; node < node_count; ++node) lower.emplace_back(node, node);
  std::sort(lower.begin(), lower.end());
  lower.erase(std::unique(lower.begin(), lower.end()), lower.end());

  const auto n = static_cast<size_t>(node_count);
  cholmod_sparse* graph =
      cholmod_allocate_sparse(n, n, lower.size(), 1, 1, -1, CHOLMOD_PATTERN, common);
  PALPATE_CHECK(graph != nullptr, node_count, lower.size());
  int* column_start = static_cast<int*>(graph->p);
  int* row = static_cast<int*>(graph->i);
  std::fill_n(column_start, n + 1, 0);
  for (size_t k = 0; k < lower.size(); ++k) {
    ++column_start[lower[k].first + 1];
    row[k] = lower[k].second;
  }
  for (size_t j = 0; j < n; ++j) column_start[j + 1] += column_start[j];
  return graph;
}

}  // namespace

std::vector<int> FillReducingOrder(int node_count, const NodePairs& pairs) {
  internal::CholmodContext context;
  cholmod_common* common = context.get();
  common->nmethods = 3;
  common->method[0].ordering = CHOLMOD_AMD;
  common->method[1].ordering = CHOLMOD_METIS;
  common->method[2].ordering = CHOLMOD_NESDIS;
  common->postorder = 1;
  cholmod_sparse* graph = MakeGraph(node_count, pairs, common);
  cholmod_factor* factor = cholmod_analyze(graph, common);
  PALPATE_CHECK(factor != nullptr, common->status);
  const int* permutation = static_cast<const int*>(factor->Perm);
  std::vector<int> order(permutation, permutation + node_count);
  cholmod_free_factor(&factor, common);
  cholmod_free_sparse(&graph, common);
  return order;
}

}  // namespace palpate::fem
