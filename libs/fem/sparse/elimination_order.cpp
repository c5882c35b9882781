// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/sparse/elimination_order.hpp"

#include <algorithm>
#include <limits>
#include <mutex>
#include <numeric>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/fem/sparse/amalgamation.hpp"
#include "libs/fem/sparse/cholmod_context.hpp"
#include "libs/fem/sparse/minimum_fill.hpp"

namespace palpate::fem {

namespace {

/// The graph as the pattern of a lower triangle with its diagonal.
cholmod_sparse* ToCholmod(const internal::NodeGraph& graph, cholmod_common* common) {
  const auto n = static_cast<size_t>(graph.NodeCount());
  const size_t entries = n + graph.neighbours.size() / 2;
  cholmod_sparse* sparse =
      cholmod_allocate_sparse(n, n, entries, 1, 1, -1, CHOLMOD_PATTERN, common);
  PALPATE_CHECK(sparse != nullptr, n, entries);
  int* column_start = static_cast<int*>(sparse->p);
  int* row = static_cast<int*>(sparse->i);
  int next = 0;
  for (int column = 0; column < graph.NodeCount(); ++column) {
    column_start[column] = next;
    row[next++] = column;
    for (int e = graph.start[At(column)]; e < graph.start[static_cast<size_t>(column) + 1]; ++e) {
      const int neighbour = graph.neighbours[At(e)];
      if (neighbour > column) row[next++] = neighbour;
    }
  }
  column_start[n] = next;
  return sparse;
}

/// One at a time: METIS draws from the process's one stream of random numbers, and puts handlers of
/// its own on SIGTERM and SIGABRT while it works. Two at once change each other's order, and leave
/// a handler behind that jumps into a frame that has returned.
std::vector<int> Order(cholmod_sparse* graph, int method, cholmod_common* common) {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  common->nmethods = 1;
  common->method[0].ordering = method;
  common->postorder = 1;
  cholmod_factor* factor = cholmod_analyze(graph, common);
  PALPATE_CHECK(factor != nullptr, common->status);
  const int* permutation = static_cast<const int*>(factor->Perm);
  std::vector<int> order(permutation, permutation + graph->nrow);
  cholmod_free_factor(&factor, common);
  return order;
}

}  // namespace

EliminationOrder FindEliminationOrder(int node_count, const NodePairs& pairs) {
  const internal::NodeGraph graph = internal::MakeNodeGraph(node_count, pairs);
  internal::CholmodContext context;
  cholmod_common* common = context.get();
  cholmod_sparse* sparse = ToCholmod(graph, common);
  internal::Amalgamated best;
  best.cost = std::numeric_limits<double>::infinity();
  const auto compare = [&](const std::vector<int>& order) {
    internal::Amalgamated candidate = internal::Amalgamate(graph, order);
    if (candidate.cost < best.cost) best = std::move(candidate);
  };
  for (const int method : {CHOLMOD_AMD, CHOLMOD_METIS, CHOLMOD_NESDIS}) {
    compare(Order(sparse, method, common));
  }
  cholmod_free_sparse(&sparse, common);
  const std::vector<int> fill_order = internal::MinimumMeanFillOrder(graph);
  if (static_cast<int>(fill_order.size()) == node_count) compare(fill_order);
  return std::move(best.order);
}

}  // namespace palpate::fem
