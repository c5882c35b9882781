// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>

#include "libs/core/check.hpp"
#include "libs/fem/tet_mesh.hpp"

namespace palpate::fem {

namespace {

constexpr std::array<std::pair<int, int>, 6> kTetEdges = {
    {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};

/// The same for both directions of an edge.
uint64_t EdgeKey(int a, int b) {
  const auto [low, high] = std::minmax(a, b);
  return static_cast<uint64_t>(low) << 32 | static_cast<uint64_t>(high);
}

}  // namespace

TetMesh MakeQuadratic(const TetMesh& mesh) {
  if (mesh.element_type() == ElementType::kTet10) return mesh;
  PALPATE_CHECK(mesh.cells.rows() == 4, mesh.cells.rows());
  TetMesh quadratic;
  quadratic.groups = mesh.groups;
  quadratic.cells.resize(10, mesh.CellCount());
  quadratic.cells.topRows(4) = mesh.cells;

  std::unordered_map<uint64_t, int> node_of_edge;
  node_of_edge.reserve(static_cast<size_t>(mesh.CellCount()) * 2);
  std::vector<std::pair<int, int>> ends;
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    for (size_t edge = 0; edge < kTetEdges.size(); ++edge) {
      const int a = mesh.cells(kTetEdges[edge].first, cell);
      const int b = mesh.cells(kTetEdges[edge].second, cell);
      const int next = mesh.NodeCount() + static_cast<int>(ends.size());
      const auto [entry, is_new] = node_of_edge.try_emplace(EdgeKey(a, b), next);
      if (is_new) ends.emplace_back(a, b);
      quadratic.cells(4 + static_cast<int>(edge), cell) = entry->second;
    }
  }

  const int64_t node_count = mesh.NodeCount() + static_cast<int64_t>(ends.size());
  PALPATE_CHECK(node_count <= std::numeric_limits<int>::max() / 3, node_count);
  quadratic.nodes_m.resize(3, node_count);
  quadratic.nodes_m.leftCols(mesh.NodeCount()) = mesh.nodes_m;
  for (size_t k = 0; k < ends.size(); ++k) {
    quadratic.nodes_m.col(mesh.NodeCount() + static_cast<int>(k)) =
        0.5 * (mesh.nodes_m.col(ends[k].first) + mesh.nodes_m.col(ends[k].second));
  }
  return quadratic;
}

}  // namespace palpate::fem
