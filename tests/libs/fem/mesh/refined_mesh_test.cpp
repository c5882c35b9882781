// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/refined_mesh.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "libs/fem/mesh_report.hpp"

namespace palpate::fem {
namespace {

TetMesh TwoCells() {
  TetMesh mesh;
  mesh.nodes_m.resize(3, 5);
  mesh.nodes_m << 0.0, 1.0, 0.1, 0.2, 1.0,  //
      0.0, 0.0, 1.0, 0.1, 1.1,              //
      0.0, 0.1, 0.0, 1.0, 0.9;
  mesh.cells.resize(4, 2);
  mesh.cells << 0, 1,  //
      1, 2,            //
      2, 3,            //
      3, 4;
  return mesh;
}

double Volume(const TetMesh& mesh, int cell) {
  const Eigen::Vector3d origin = mesh.nodes_m.col(mesh.cells(0, cell));
  return (mesh.nodes_m.col(mesh.cells(1, cell)) - origin)
             .cross(mesh.nodes_m.col(mesh.cells(2, cell)) - origin)
             .dot(mesh.nodes_m.col(mesh.cells(3, cell)) - origin) /
         6.0;
}

TEST(RefinedMesh, CutsEachCellIntoEightPartsOfOneSize) {
  const TetMesh mesh = TwoCells();
  const TetMesh fine = RefineUniformly(mesh);
  ASSERT_EQ(fine.CellCount(), 16);
  EXPECT_EQ(fine.nodes_m.leftCols(5), mesh.nodes_m);
  for (int part = 0; part < fine.CellCount(); ++part) {
    EXPECT_NEAR(Volume(fine, part), Volume(mesh, part / 8) / 8.0, 1e-15) << part;
  }
}

TEST(RefinedMesh, HasNoGapBetweenNeighbours) {
  const MeshReport report = ReportMesh(RefineUniformly(TwoCells()));
  EXPECT_EQ(report.pieces, 1);
  EXPECT_TRUE(report.inverted_cells.empty());
  EXPECT_NEAR(report.volume_m3, ReportMesh(TwoCells()).volume_m3, 1e-15);
}

}  // namespace
}  // namespace palpate::fem
