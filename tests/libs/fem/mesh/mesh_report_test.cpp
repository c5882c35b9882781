// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/mesh_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "libs/core/error.hpp"
#include "tests/libs/fem/mesh/mesh_files.hpp"

namespace palpate::fem {
namespace {

using test::CubeMesh;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string RefusalOf(const TetMesh& mesh, Pieces pieces = Pieces::kOneOnly) {
  try {
    CheckSolvable(mesh, ReportMesh(mesh), "body.vtu", pieces);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// Two meshes as one, without common nodes.
TetMesh Together(const TetMesh& a, const TetMesh& b) {
  TetMesh both;
  both.nodes_m.resize(3, a.NodeCount() + b.NodeCount());
  both.nodes_m << a.nodes_m, b.nodes_m;
  both.cells.resize(4, a.CellCount() + b.CellCount());
  both.cells << a.cells, b.cells.array() + a.NodeCount();
  return both;
}

TEST(MeshReport, DescribesACube) {
  for (const TetMesh& mesh : {CubeMesh(4), MakeQuadratic(CubeMesh(4))}) {
    const MeshReport report = ReportMesh(mesh);
    EXPECT_EQ(report.cell_count, 384);
    EXPECT_EQ(report.nodes_per_cell, mesh.cells.rows());
    EXPECT_NEAR(report.volume_m3, 1.0, 1e-14);
    EXPECT_EQ(report.min_m, Eigen::Vector3d(0, 0, 0));
    EXPECT_EQ(report.max_m, Eigen::Vector3d(1, 1, 1));
    EXPECT_EQ(report.boundary_triangles, 6 * 16 * 2);
    EXPECT_EQ(report.free_edges, 0);
    EXPECT_EQ(report.overshared_faces, 0);
    EXPECT_EQ(report.pieces, 1);
    EXPECT_EQ(report.parts, 1);
    EXPECT_THAT(report.unused_nodes, IsEmpty());
    EXPECT_THAT(report.duplicate_nodes, IsEmpty());
    EXPECT_EQ(RefusalOf(mesh), "");
  }
}

TEST(MeshReport, QualityIsOneForTheRegularTetrahedronAtAnySizeAndPose) {
  TetMesh mesh;
  mesh.nodes_m.resize(3, 4);
  mesh.nodes_m << 1, 1, -1, -1, 1, -1, -1, 1, 1, -1, 1, -1;
  mesh.nodes_m = (1e-3 * mesh.nodes_m).colwise() + Eigen::Vector3d(0.1, 0.2, 0.3);
  mesh.cells = Eigen::Vector4i(0, 1, 2, 3);
  EXPECT_NEAR(ReportMesh(mesh).worst_quality, 1.0, 1e-12);
}

TEST(MeshReport, QualityOfTheCornerTetrahedronIsItsClosedForm) {
  TetMesh mesh;
  mesh.nodes_m.resize(3, 4);
  mesh.nodes_m << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
  mesh.cells = Eigen::Vector4i(0, 1, 2, 3);
  const double squared_lengths = 3 * 1.0 + 3 * 2.0;
  EXPECT_NEAR(ReportMesh(mesh).worst_quality, 12.0 * std::cbrt(0.25) / squared_lengths, 1e-14);
}

TEST(MeshReport, VolumeOfCurvedCellsIsExact) {
  // x -> x + a y^2 keeps volumes, and a quadratic cell follows it exactly.
  TetMesh mesh = MakeQuadratic(CubeMesh(2));
  mesh.nodes_m.row(0).array() += 0.3 * mesh.nodes_m.row(1).array().square();
  EXPECT_NEAR(ReportMesh(mesh).volume_m3, 1.0, 1e-14);
  // x -> x + b x^2 sends the cube to a box of length 1 + b.
  mesh = MakeQuadratic(CubeMesh(2));
  mesh.nodes_m.row(0).array() += 0.3 * mesh.nodes_m.row(0).array().square();
  EXPECT_NEAR(ReportMesh(mesh).volume_m3, 1.3, 1e-14);
  // The same in x, y and z: now det J is a full cubic.
  mesh = MakeQuadratic(CubeMesh(2));
  mesh.nodes_m.array() += 0.3 * mesh.nodes_m.array().square();
  EXPECT_NEAR(ReportMesh(mesh).volume_m3, 1.3 * 1.3 * 1.3, 1e-13);
}

TEST(MeshReport, FindsInvertedCells) {
  TetMesh mesh = CubeMesh(2);
  std::swap(mesh.cells(0, 7), mesh.cells(1, 7));
  std::swap(mesh.cells(2, 40), mesh.cells(3, 40));
  EXPECT_THAT(ReportMesh(mesh).inverted_cells, ElementsAre(7, 40));
  EXPECT_EQ(RefusalOf(mesh), "body.vtu: 2 inverted cells: 7, 40");
}

TEST(MeshReport, FindsQuadraticCellsThatFoldThoughTheirCornersAreSound) {
  TetMesh mesh = MakeQuadratic(CubeMesh(1));
  // Node 4 of cell 0 is on an edge of cell 5, which folds; cell 0 only bulges.
  mesh.nodes_m.col(mesh.cells(4, 0)) += Eigen::Vector3d(0, 0, 1.2);
  EXPECT_THAT(ReportMesh(mesh).inverted_cells, ElementsAre(5));
  EXPECT_THAT(RefusalOf(mesh), HasSubstr("inverted cells: 5"));
}

TEST(MeshReport, FindsDegenerateCells) {
  TetMesh mesh = CubeMesh(2);
  mesh.cells(3, 5) = mesh.cells(2, 5);
  const MeshReport report = ReportMesh(mesh);
  EXPECT_THAT(report.degenerate_cells, ElementsAre(5));
  EXPECT_EQ(report.worst_cell, 5);
  EXPECT_EQ(report.worst_quality, 0.0);
  EXPECT_THAT(RefusalOf(mesh), HasSubstr("1 degenerate cells (flat, or a node twice): 5"));

  mesh = CubeMesh(1);
  mesh.nodes_m.row(2) *= 1e-12;
  EXPECT_EQ(ReportMesh(mesh).degenerate_cells.size(), 6u);
  EXPECT_THAT(RefusalOf(mesh), HasSubstr("0, 1, 2, 3, 4 and 1 more"));
}

TEST(MeshReport, FindsDuplicateCellsWhateverTheOrderOfTheirNodes) {
  const TetMesh cube = CubeMesh(2);
  TetMesh mesh = cube;
  mesh.cells.conservativeResize(4, cube.CellCount() + 1);
  mesh.cells.col(cube.CellCount()) << cube.cells(1, 9), cube.cells(2, 9), cube.cells(0, 9),
      cube.cells(3, 9);
  const MeshReport report = ReportMesh(mesh);
  EXPECT_THAT(report.duplicate_cells, ElementsAre(48));
  EXPECT_EQ(report.boundary_triangles, 48);
  EXPECT_THAT(RefusalOf(mesh), HasSubstr("1 duplicate cells (same corners as an earlier one): 48"));
}

/// As files of several pieces hold it where each piece was written with the whole.
TEST(MeshReport, FindsABodyThatIsThereTwice) {
  const TetMesh cube = CubeMesh(2);
  TetMesh mesh = cube;
  mesh.nodes_m.conservativeResize(3, 2 * cube.NodeCount());
  mesh.nodes_m.rightCols(cube.NodeCount()) = cube.nodes_m;
  mesh.cells.conservativeResize(4, 2 * cube.CellCount());
  mesh.cells.rightCols(cube.CellCount()) = cube.cells.array() + cube.NodeCount();
  EXPECT_EQ(std::ssize(ReportMesh(mesh).duplicate_cells), cube.CellCount());
  EXPECT_THAT(RefusalOf(mesh), HasSubstr("48 duplicate cells"));
}

TEST(MeshReport, FindsOverlappingCells) {
  TetMesh mesh = CubeMesh(2);
  mesh.nodes_m.conservativeResize(3, 28);
  mesh.nodes_m.col(27) << 0.3, 0.2, 0.1;
  mesh.cells.conservativeResize(4, 49);
  // Over the inner face 0-1-3 of two neighbours around the diagonal, a third cell.
  mesh.cells.col(48) << mesh.cells(0, 0), mesh.cells(2, 0), mesh.cells(3, 0), 27;
  EXPECT_EQ(ReportMesh(mesh).overshared_faces, 1);
  TetMesh oriented = mesh;
  if (!ReportMesh(mesh).inverted_cells.empty()) {
    std::swap(oriented.cells(0, 48), oriented.cells(1, 48));
  }
  EXPECT_THAT(RefusalOf(oriented), HasSubstr("1 faces are shared by more than two cells"));
}

TEST(MeshReport, CountsPiecesAndRefusesThemUnlessAllowed) {
  TetMesh far = CubeMesh(1);
  far.nodes_m.row(0).array() += 2.0;
  const TetMesh mesh = Together(CubeMesh(2), far);
  EXPECT_EQ(ReportMesh(mesh).pieces, 2);
  EXPECT_THAT(RefusalOf(mesh), HasSubstr("in 2 pieces without a common node (0 nodes coincide"));
  EXPECT_EQ(RefusalOf(mesh, Pieces::kSeveralAllowed), "");
}

TEST(MeshReport, FindsNodesAtTheSamePlace) {
  TetMesh beside = CubeMesh(1);
  beside.nodes_m.row(0).array() += 1.0;
  const TetMesh mesh = Together(CubeMesh(1), beside);
  const MeshReport report = ReportMesh(mesh);
  EXPECT_THAT(report.duplicate_nodes, ElementsAre(8, 10, 12, 14));
  EXPECT_THAT(RefusalOf(mesh), HasSubstr("(4 nodes coincide with another)"));
}

TEST(MeshReport, SeesCubesThatHangTogetherByAnEdgeOrANode) {
  TetMesh cube = CubeMesh(2);
  std::vector<int> kept;
  for (int cell = 0; cell < cube.CellCount(); ++cell) {
    if (cell / 6 == 0 || cell / 6 == 3) kept.push_back(cell);  // at (0,0,0) and (1,1,0)
  }
  TetMesh by_edge = cube;
  by_edge.cells = cube.cells(Eigen::all, kept).eval();
  const MeshReport report = ReportMesh(by_edge);
  EXPECT_EQ(report.pieces, 1);
  EXPECT_EQ(report.parts, 2);
  EXPECT_EQ(report.free_edges, 1);
  EXPECT_THAT(ToText(report), HasSubstr("hang together by an edge or node"));
  EXPECT_EQ(report.unused_nodes.size(), 27u - 14u);
}

TEST(MeshReport, ToleratesUnusedNodesAndLeavesThemOutOfTheBox) {
  TetMesh mesh = CubeMesh(1);
  mesh.nodes_m.conservativeResize(3, 9);
  mesh.nodes_m.col(8) << 9, 9, 9;
  const MeshReport report = ReportMesh(mesh);
  EXPECT_THAT(report.unused_nodes, ElementsAre(8));
  EXPECT_EQ(report.max_m, Eigen::Vector3d(1, 1, 1));
  EXPECT_EQ(report.pieces, 1);
  EXPECT_EQ(RefusalOf(mesh), "");
}

TEST(MeshReport, RefusesNoCellsMissingNodesAndNaN) {
  TetMesh mesh = CubeMesh(1);
  mesh.cells.resize(4, 0);
  EXPECT_THAT(RefusalOf(mesh), HasSubstr("has no cells"));
  EXPECT_THAT(RefusalOf(TetMesh{}), HasSubstr("has no cells"));

  mesh = CubeMesh(1);
  mesh.cells(2, 4) = 8;
  mesh.cells(1, 5) = -1;
  EXPECT_THAT(RefusalOf(mesh), HasSubstr("2 cells name a node that does not exist: 4, 5"));

  mesh = CubeMesh(1);
  mesh.nodes_m(1, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(RefusalOf(mesh), HasSubstr("1 nodes have a coordinate that is not finite: 3"));
}

TEST(MeshReport, TextFitsOnOneScreen) {
  TetMesh mesh = CubeMesh(4);
  for (int cell = 0; cell < 300; ++cell) std::swap(mesh.cells(0, cell), mesh.cells(1, cell));
  const std::string text = ToText(ReportMesh(mesh));
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 24);
  size_t longest = 0;
  for (size_t start = 0, end; (end = text.find('\n', start)) != std::string::npos;
       start = end + 1) {
    longest = std::max(longest, end - start);
  }
  EXPECT_LT(longest, 100u);
  EXPECT_THAT(text, AllOf(HasSubstr("125 nodes and 384 tetrahedra of 4 nodes"),
                          HasSubstr("inverted cells      300 (0, 1, 2, 3, 4 and 295 more)")));
}

}  // namespace
}  // namespace palpate::fem
