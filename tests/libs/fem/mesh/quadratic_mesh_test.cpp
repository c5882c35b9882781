// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "libs/fem/tet_mesh.hpp"
#include "tests/libs/fem/mesh/mesh_files.hpp"

namespace palpate::fem {
namespace {

constexpr int kEdges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};

TEST(MakeQuadratic, PutsOneNodeOnTheMiddleOfEveryEdge) {
  const TetMesh mesh = test::CubeMesh(3);
  const TetMesh quadratic = MakeQuadratic(mesh);
  std::set<std::pair<int, int>> edges;
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    for (int k = 0; k < 6; ++k) {
      const auto [a, b] =
          std::minmax(mesh.cells(kEdges[k][0], cell), mesh.cells(kEdges[k][1], cell));
      edges.emplace(a, b);
      const Eigen::Vector3d middle = 0.5 * (mesh.nodes_m.col(a) + mesh.nodes_m.col(b));
      EXPECT_EQ(quadratic.nodes_m.col(quadratic.cells(4 + k, cell)), middle);
    }
  }
  EXPECT_EQ(quadratic.NodeCount(), mesh.NodeCount() + static_cast<int>(edges.size()));
}

TEST(MakeQuadratic, KeepsCornersAndNumbersNewNodesInTheOrderOfTheCells) {
  const TetMesh mesh = test::CubeMesh(2);
  const TetMesh quadratic = MakeQuadratic(mesh);
  EXPECT_EQ(quadratic.nodes_m.leftCols(mesh.NodeCount()), mesh.nodes_m);
  EXPECT_EQ(quadratic.cells.topRows(4), mesh.cells);
  int next = mesh.NodeCount();
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    for (int k = 4; k < 10; ++k) {
      ASSERT_LE(quadratic.cells(k, cell), next);
      next = std::max(next, quadratic.cells(k, cell) + 1);
    }
  }
  EXPECT_EQ(next, quadratic.NodeCount());
}

TEST(MakeQuadratic, KeepsGroupsAndLeavesQuadraticMeshesAlone) {
  TetMesh mesh = test::CubeMesh(1);
  mesh.groups = {{"leg", {0, 2, 5}}, {"top", {1, 3}}};
  const TetMesh once = MakeQuadratic(mesh);
  EXPECT_EQ(once.groups, mesh.groups);
  EXPECT_TRUE(test::SameMesh(MakeQuadratic(once), once));
}

}  // namespace
}  // namespace palpate::fem
