// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/mesh_io/read_mesh.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <stdexcept>

#include "libs/core/error.hpp"
#include "libs/fem/mesh_report.hpp"
#include "tests/libs/fem/mesh/mesh_files.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::fem {
namespace {

using test::AsciiVtu;
using test::CubeMesh;
using test::MeshFile;
using test::ReadBytes;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The mesh as often, one after another.
TetMesh Repeated(const TetMesh& mesh, int times) {
  TetMesh repeated;
  repeated.nodes_m = mesh.nodes_m.replicate(1, times);
  repeated.cells = mesh.cells.replicate(1, times);
  for (int k = 0; k < times; ++k) {
    repeated.cells.middleCols(k * mesh.CellCount(), mesh.CellCount()).array() +=
        k * mesh.NodeCount();
  }
  return repeated;
}

std::string RefusalFromDisk(const std::filesystem::path& file) {
  try {
    ReadMesh(file, 1.0);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

class EveryFormat : public testing::TestWithParam<int> {};

TEST_P(EveryFormat, GivesBackTheMeshThatWasWritten) {
  const TetMesh tet4 = CubeMesh(2);
  const TetMesh mesh = GetParam() == 4 ? tet4 : MakeQuadratic(tet4);
  const test_support::TestFolder folder;
  for (const MeshFile& file : test::AllFiles(mesh, {})) {
    SCOPED_TRACE(file.name);
    std::vector<std::string> notes;
    const TetMesh read = ReadMesh(test::WriteMeshFile(folder, file), 1e-3, &notes);
    TetMesh expected = Repeated(mesh, file.name.find("two_pieces") == std::string::npos ? 1 : 2);
    expected.nodes_m *= 1e-3;
    EXPECT_TRUE(test::SameMesh(read, expected));
    EXPECT_THAT(notes, IsEmpty());
  }
}

TEST_P(EveryFormat, PassesOverTheTrianglesOfTheSurface) {
  const TetMesh tet4 = CubeMesh(2);
  const TetMesh mesh = GetParam() == 4 ? tet4 : MakeQuadratic(tet4);
  const std::vector<int> surface = test::CubeSurface(tet4);
  ASSERT_EQ(surface.size(), 3u * 48u);
  for (const MeshFile& file : test::AllFiles(mesh, surface)) {
    SCOPED_TRACE(file.name);
    const bool twice = file.name.find("two_pieces") != std::string::npos;
    EXPECT_TRUE(test::SameMesh(ReadBytes(file), Repeated(mesh, twice ? 2 : 1)));
  }
}

INSTANTIATE_TEST_SUITE_P(ReadMesh, EveryFormat, testing::Values(4, 10),
                         [](const auto& nodes) { return "Tet" + std::to_string(nodes.param); });

TEST(ReadMesh, KeepsThePhysicalVolumesOfGmshAsGroups) {
  for (const MeshFile& file : test::AllGmshFiles(CubeMesh(1), {})) {
    SCOPED_TRACE(file.name);
    const TetMesh mesh = ReadBytes(file);
    EXPECT_THAT(mesh.groups, ElementsAre(CellGroup{"soft body", {0, 1, 2, 3, 4, 5}}));
  }
}

TEST(ReadMesh, NumbersGmshNodesByTheirTags) {
  const std::string bytes =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n70 0 0 1\n10 0 0 0\n40 0 1 0\n20 1 0 0\n"
      "$EndNodes\n$Elements\n1\n1 4 0 10 20 40 70\n$EndElements\n";
  const TetMesh mesh = ReadBytes({"sparse.msh", bytes});
  EXPECT_EQ(mesh.cells, Eigen::Vector4i(0, 1, 2, 3));
  EXPECT_EQ(mesh.nodes_m.col(3), Eigen::Vector3d(0, 0, 1));
  EXPECT_THAT(mesh.groups, IsEmpty());
}

TEST(ReadMesh, KeepsNodesThatNoCellUses) {
  const TetMesh cube = CubeMesh(1);
  TetMesh mesh = cube;
  mesh.nodes_m.resize(3, 10);
  mesh.nodes_m << Eigen::Vector3d(5, 5, 5), cube.nodes_m, Eigen::Vector3d(6, 6, 6);
  mesh.cells.array() += 1;
  for (const MeshFile& file : test::AllFiles(mesh, {})) {
    SCOPED_TRACE(file.name);
    const TetMesh read = ReadBytes(file);
    ASSERT_GE(read.NodeCount(), 10);
    EXPECT_EQ(read.nodes_m.leftCols(10), mesh.nodes_m);
  }
}

TEST(ReadMesh, TurnsAllCellsWhereTheConventionIsTheOppositeOneAndSaysSo) {
  for (const TetMesh& mesh : {CubeMesh(1), MakeQuadratic(CubeMesh(1))}) {
    TetMesh mirrored = mesh;
    mirrored.nodes_m.row(0) *= -1.0;
    const test_support::TestFolder folder;
    std::vector<std::string> notes;
    const TetMesh read =
        ReadMesh(test::WriteMeshFile(folder, {"m.vtu", AsciiVtu(mirrored)}), 1.0, &notes);
    EXPECT_THAT(notes, ElementsAre(HasSubstr("were turned")));
    const MeshReport report = ReportMesh(read);
    EXPECT_THAT(report.inverted_cells, IsEmpty());
    EXPECT_DOUBLE_EQ(report.volume_m3, 1.0);
  }
}

TEST(ReadMesh, TurnsSingleCellsThatWereOnlyWrittenTheOtherWayRound) {
  for (const TetMesh& mesh : {CubeMesh(2), MakeQuadratic(CubeMesh(2))}) {
    TetMesh mixed = mesh;
    for (const int cell : {1, 3, 17}) {
      mixed.cells.col(cell).row(1).swap(mixed.cells.col(cell).row(2));
      if (mixed.cells.rows() == 4) continue;
      mixed.cells.col(cell).row(4).swap(mixed.cells.col(cell).row(6));
      mixed.cells.col(cell).row(8).swap(mixed.cells.col(cell).row(9));
    }
    std::vector<std::string> notes;
    const test_support::TestFolder folder;
    const TetMesh read =
        ReadMesh(test::WriteMeshFile(folder, {"m.vtu", AsciiVtu(mixed)}), 1.0, &notes);
    EXPECT_TRUE(test::SameMesh(read, mesh));
    EXPECT_THAT(notes, ElementsAre(HasSubstr("3 of 48 cells")));
  }
}

TEST(ReadMesh, LeavesCellsAsTheyAreWhereANodeLiesBeyondAFace) {
  TetMesh mesh = CubeMesh(2);
  int middle = 0;
  (mesh.nodes_m.colwise() - Eigen::Vector3d::Constant(0.5)).colwise().norm().minCoeff(&middle);
  mesh.nodes_m.col(middle) += Eigen::Vector3d(0.9, 0.1, 0.05);
  std::vector<std::string> notes;
  const test_support::TestFolder folder;
  const TetMesh read =
      ReadMesh(test::WriteMeshFile(folder, {"m.vtu", AsciiVtu(mesh)}), 1.0, &notes);
  EXPECT_TRUE(test::SameMesh(read, mesh));
  EXPECT_THAT(notes, IsEmpty());
  EXPECT_FALSE(ReportMesh(read).inverted_cells.empty());
}

TEST(ReadMesh, RefusesFilesThatAreMissingEmptyOrOfUnknownEnding) {
  const test_support::TestFolder folder;
  EXPECT_THAT(RefusalFromDisk(folder.path() / "none.vtu"), HasSubstr("none.vtu: mesh file not"));
  EXPECT_THAT(RefusalFromDisk(test::WriteMeshFile(folder, {"empty.msh", ""})),
              HasSubstr("is empty"));
  EXPECT_THAT(RefusalFromDisk(test::WriteMeshFile(folder, {"cube.stl", "solid"})),
              HasSubstr(".vtu, .vtk, .msh"));
  std::filesystem::create_directory(folder.path() / "folder.vtu");
  EXPECT_THAT(RefusalFromDisk(folder.path() / "folder.vtu"), HasSubstr("not a regular file"));
}

TEST(ReadMesh, ReadsEndingsInCapitals) {
  const test_support::TestFolder folder;
  EXPECT_EQ(
      ReadMesh(test::WriteMeshFile(folder, {"CUBE.VTU", AsciiVtu(CubeMesh(1))}), 1.0).CellCount(),
      6);
}

/// Files of Gmsh itself: an independent writer.
class GmshProgram : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("gmsh -version > /dev/null 2>&1") != 0) GTEST_SKIP() << "gmsh not installed";
    test::WriteMeshFile(
        folder_, {"two.geo",
                  "SetFactory(\"OpenCASCADE\"); Box(1) = {0,0,0, 30,30,50};\n"
                  "Box(2) = {0,0,50, 30,30,50};\n"
                  "BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }\n"
                  "Physical Volume(\"lower part\") = {1}; Physical Volume(\"upper\") = {2};\n"
                  "Physical Surface(\"skin\") = {1,2,3}; Mesh.MeshSizeMax = 15;\n"});
  }

  TetMesh MeshedBy(const std::string& options, const std::string& file) {
    const std::string command = "cd '" + folder_.path().string() + "' && gmsh -3 two.geo " +
                                options + " -o " + file + " -v 0 > /dev/null 2>&1";
    if (std::system(command.c_str()) != 0) throw std::runtime_error(command);
    return ReadMesh(folder_.path() / file, 1e-3);
  }

  test_support::TestFolder folder_;
};

TEST_F(GmshProgram, WritesTheSameMeshInEveryFormat) {
  for (const std::string order : {"1", "2"}) {
    const TetMesh reference = MeshedBy("-order " + order + " -format msh41", "reference.msh");
    EXPECT_EQ(reference.cells.rows(), order == "1" ? 4 : 10);
    EXPECT_THAT(reference.groups, ElementsAre(testing::Field(&CellGroup::name, "lower part"),
                                              testing::Field(&CellGroup::name, "upper")));
    EXPECT_NEAR(ReportMesh(reference).volume_m3, 9e-5, 1e-12);
    for (const std::string format : {"msh22", "msh22 -bin", "msh40", "msh40 -save_parametric",
                                     "msh41 -bin", "msh41 -save_parametric", "vtk", "vtk -bin"}) {
      SCOPED_TRACE("order " + order + " " + format);
      const TetMesh mesh = MeshedBy("-order " + order + " -format " + format,
                                    format.starts_with("vtk") ? "mesh.vtk" : "mesh.msh");
      EXPECT_EQ(mesh.cells, reference.cells);
      ASSERT_EQ(mesh.NodeCount(), reference.NodeCount());
      EXPECT_LT((mesh.nodes_m - reference.nodes_m).cwiseAbs().maxCoeff(), 1e-15);
      if (format.starts_with("vtk")) continue;
      EXPECT_EQ(mesh.groups, reference.groups);
    }
  }
}

TEST_F(GmshProgram, PutsMidEdgeNodesWhereVtkOrderExpectsThem) {
  const TetMesh mesh = MeshedBy("-order 2 -format msh41 -bin", "mesh.msh");
  const int edges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
  const auto node = [&mesh](int k, int cell) -> Eigen::Vector3d {
    return mesh.nodes_m.col(mesh.cells(k, cell));
  };
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    for (int edge = 0; edge < 6; ++edge) {
      const Eigen::Vector3d middle =
          0.5 * (node(edges[edge][0], cell) + node(edges[edge][1], cell));
      ASSERT_LT((node(4 + edge, cell) - middle).norm(), 1e-12);
    }
  }
}

}  // namespace
}  // namespace palpate::fem
