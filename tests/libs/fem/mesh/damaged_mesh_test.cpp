// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <exception>
#include <limits>
#include <random>

#include "libs/core/error.hpp"
#include "libs/fem/mesh_report.hpp"
#include "tests/libs/fem/mesh/mesh_files.hpp"

namespace palpate::fem {
namespace {

using test::AsciiGmsh22;
using test::AsciiGmsh41;
using test::AsciiVtk;
using test::AsciiVtu;
using test::CubeMesh;
using test::MeshFile;
using test::ReadBytes;
using test::RefusalOf;
using test::Replaced;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(DamagedMesh, IsNeverHalfReadWhereverTheFileIsCut) {
  const TetMesh cube = CubeMesh(1);
  for (const TetMesh& mesh : {cube, MakeQuadratic(cube)}) {
    for (const MeshFile& file : test::AllFiles(mesh, {0, 1, 3})) {
      const TetMesh whole = ReadBytes(file);
      for (size_t length = 0; length < file.bytes.size(); ++length) {
        try {
          const TetMesh read = ReadBytes({file.name, file.bytes.substr(0, length)});
          ASSERT_TRUE(test::SameMesh(read, whole)) << file.name << " cut at " << length;
          ASSERT_GE(length + 2, file.bytes.size()) << file.name << " cut at " << length;
        } catch (const InputError&) {
        }
      }
    }
  }
}

TEST(DamagedMesh, IsRefusedOrReadButNeverCrashes) {
  std::mt19937 random(20261121);
  for (const MeshFile& file : test::AllFiles(CubeMesh(1), {0, 1, 3})) {
    for (int trial = 0; trial < 400; ++trial) {
      MeshFile damaged = file;
      const auto flips = 1 + random() % 4;
      for (size_t flip = 0; flip < flips; ++flip) {
        damaged.bytes[random() % damaged.bytes.size()] = static_cast<char>(random() % 256);
      }
      try {
        const TetMesh mesh = ReadBytes(damaged);
        EXPECT_FALSE(ToText(ReportMesh(mesh)).empty());
        ASSERT_TRUE(mesh.nodes_m.allFinite());
        ASSERT_GE(mesh.cells.minCoeff(), 0);
        ASSERT_LT(mesh.cells.maxCoeff(), mesh.NodeCount());
      } catch (const InputError&) {
      } catch (const std::exception& error) {
        FAIL() << file.name << " trial " << trial << ": " << error.what();
      }
    }
  }
}

TEST(DamagedMesh, NaNInACoordinateIsRefusedInEveryFormat) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()}) {
    TetMesh mesh = CubeMesh(1);
    mesh.nodes_m(1, 5) = bad;
    for (const MeshFile& file : test::AllFiles(mesh, {})) {
      const char* where = file.name.ends_with(".vtu") ? "array 'Points': " : "a coordinate";
      EXPECT_THAT(RefusalOf(file),
                  AllOf(StartsWith(file.name), HasSubstr(where), HasSubstr("finite")));
    }
  }
}

struct Damage {
  const char* from;
  const char* to;
  const char* message;
};

void ExpectRefusals(const std::string& name, const std::string& bytes,
                    const std::vector<Damage>& damages) {
  for (const Damage& damage : damages) {
    SCOPED_TRACE(std::string(damage.from) + " -> " + damage.to);
    EXPECT_THAT(RefusalOf({name, Replaced(bytes, damage.from, damage.to)}),
                AllOf(StartsWith(name), HasSubstr(damage.message)));
  }
}

TEST(DamagedMesh, VtuRefusalsSayWhatIsWrong) {
  ExpectRefusals(
      "cube.vtu", AsciiVtu(CubeMesh(1)),
      {{"UnstructuredGrid\" v", "PolyData\" v", "cube.vtu:2: <VTKFile> is of type 'PolyData'"},
       {"LittleEndian", "MiddleEndian", "byte_order 'MiddleEndian' is not read"},
       {"UInt32\">", "UInt32\" compressor=\"vtkBrotliDataCompressor\">", "vtkBrotliDataCompressor"},
       {"UInt32\">", "UInt8\">", "header_type 'UInt8'"},
       {"NumberOfPoints=\"8\"", "NumberOfPoints=\"9\"",
        "cube.vtu:6: array 'Points': holds 24 numbers instead of 27"},
       {"NumberOfPoints=\"8\"", "NumberOfPoints=\"7\"", "24 numbers instead of 21"},
       {"NumberOfPoints=\"8\"", "NumberOfPoints=\"-8\"", "<Piece> needs an attribute"},
       {"NumberOfPoints=\"8\"", "", "<Piece> needs an attribute 'NumberOfPoints'"},
       {"NumberOfPoints=\"8\"", "NumberOfPoints=\"2000000000\"", "instead of 6000000000"},
       {"NumberOfCells=\"6\"", "NumberOfCells=\"7\"", "array 'types': holds 6 numbers"},
       {"NumberOfComponents=\"3\"", "NumberOfComponents=\"2\"", "must have 3 components"},
       {"0 0 0 1", "0 0 nan 1", "cube.vtu:7: array 'Points': 'nan' is not a finite number"},
       {"0 0 0 1", "0 0 inf 1", "'inf' is not a finite number"},
       {"0 0 0 1", "0 0 1e999 1", "'1e999' is not a finite number"},
       {"0 0 0 1", "0 0 0,5 1", "'0,5' is not a finite number"},
       {"\"Float64\"", "\"String\"", "unknown type 'String'"},
       {"\"Int64\"", "\"Float32\"", "array 'connectivity': must hold integers"},
       {"\"connectivity\"", "\"nodes\"", "has no DataArray named 'connectivity'"},
       {"\"offsets\"", "\"nodes\"", "has no DataArray named 'offsets'"},
       {"\"types\"", "\"nodes\"", "has no DataArray named 'types'"},
       {"\n0\n1\n3\n7\n", "\n0\n1\n3\n8\n", "node index 8 is outside 0 to 7"},
       {"\n0\n1\n3\n7\n", "\n0\n-1\n3\n7\n", "node index -1 is outside 0 to 7"},
       {"\n0\n1\n3\n7\n", "\n0\n1.5\n3\n7\n", "cube.vtu:13: array 'connectivity': '1.5' is not an"},
       {"\n4\n8\n12\n", "\n4\n3\n12\n", "array 'offsets': must rise"},
       {"\n4\n8\n12\n", "\n4\n9\n12\n", "cell 1: has 5 nodes, a tetrahedron has 4"},
       {"\n10\n10\n", "\n10\n12\n", "cell 1: cells of type 12 (hexahedron) are not read"},
       {"\n10\n10\n", "\n10\n99\n", "cell 1: cells of type 99 (unknown) are not read"},
       {"\n10\n10\n10\n10\n10\n10\n", "\n9\n9\n9\n9\n9\n9\n", "holds no tetrahedron"},
       {"<Points>", "<Point>", "damaged or cut off"},
       {"<VTKFile", "<VTKfile", "damaged or cut off"}});
  EXPECT_THAT(RefusalOf({"x.vtu", "<a/>"}), HasSubstr("its root must be <VTKFile>"));
}

TEST(DamagedMesh, Tet4AndTet10InOneFileAreRefused) {
  const std::string mixed =
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 10 float\n"
      "0 0 0 1 0 0 0 1 0 0 0 1 .5 0 0 .5 .5 0 0 .5 0 0 0 .5 .5 0 .5 0 .5 .5\n"
      "CELLS 2 16\n4 0 1 2 3 10 0 1 2 3 4 5 6 7 8 9\nCELL_TYPES 2\n10 24\n";
  EXPECT_THAT(RefusalOf({"x.vtk", mixed}), HasSubstr("cell 1: tetrahedra of 4 and of 10 nodes"));
}

TEST(DamagedMesh, VtuBinaryRefusalsNameTheArray) {
  for (const MeshFile& file : test::AllVtuFiles(CubeMesh(1), {})) {
    if (file.name.starts_with("ascii")) continue;
    SCOPED_TRACE(file.name);
    EXPECT_THAT(RefusalOf({file.name, Replaced(file.bytes, "Points=\"8\"", "Points=\"9\"")}),
                HasSubstr("array 'Points'"));
    if (!file.name.starts_with("appended")) continue;
    EXPECT_THAT(RefusalOf({file.name, Replaced(file.bytes, "offset=\"0\"", "offset=\"99999\"")}),
                HasSubstr("array 'Points': needs an attribute 'offset' within the AppendedData"));
  }
}

TEST(DamagedMesh, VtkRefusalsSayWhatIsWrong) {
  ExpectRefusals(
      "cube.vtk", AsciiVtk(CubeMesh(1)),
      {{"# vtk DataFile", "# vtk", "cube.vtk:1:1: is no VTK legacy file"},
       {"Version 3.0", "Version 9.0", "file version is not read"},
       {"ASCII", "TEXT", "cube.vtk:3:1: must be ASCII or BINARY"},
       {"UNSTRUCTURED_GRID", "POLYDATA", "cube.vtk:4:9: only UNSTRUCTURED_GRID is read"},
       {"POINTS 8", "POINTS x", "cube.vtk:8:8: the number of points: 'x' is not an integer"},
       {"POINTS 8", "POINTS 9", "'CELLS' is not a finite number"},
       {"POINTS 8", "POINTS 2000000000", "the file is too short for 6000000000 coordinates"},
       {"POINTS 8 double", "POINTS 8 bit", "data type 'bit' is not read"},
       {"0 0 0 1", "0 0 nan 1", "cube.vtk:9:5: a coordinate: 'nan' is not a finite number"},
       {"CELLS 6 30", "CELLS 6 31", "another size than CELLS says"},
       {"CELLS 6 30", "CELLS 6 29", "is outside 0 to 3"},
       {"CELLS 6 30", "CELLS 7 6", "shorter than the number of cells"},
       {"CELLS", "VERTICES", "cube.vtk:10:1: expected CELLS"},
       {"CELL_TYPES 6", "CELL_TYPES 5", "there are 5 cell types for 6 cells"},
       {"CELL_TYPES 6", "POINT_DATA 6", "expected CELL_TYPES"},
       {"4\n0\n1\n3\n7\n", "4\n0\n1\n3\n8\n", "cell 0: node index 8 is outside 0 to 7"},
       {"\n10\n10\n", "\n10\n13\n", "cell 1: cells of type 13 (wedge) are not read"}});
}

TEST(DamagedMesh, GmshRefusalsSayWhatIsWrong) {
  const std::vector<Damage> in_both = {
      {"$MeshFormat", "$Nodes", "cube.msh:1:1: is no Gmsh file"},
      {" 0 8", " 2 8", "the file type: 2 is outside 0 to 1"},
      {" 0 8", " 0 7", "data size must be 8"},
      {"\"soft body\"", "soft", "a name stands in quotes"},
      {"$Nodes", "$Knots", "the file ends before $EndKnots"},
      {"$EndNodes", "$EndElements", "expected $EndNodes"},
      {"$EndElements", "$EndNodes", "expected $EndElements"},
      {"$EndComments", "$EndComment", "the file ends before $EndComments"}};
  ExpectRefusals("cube.msh", AsciiGmsh22(CubeMesh(1)), in_both);
  ExpectRefusals("cube.msh", AsciiGmsh41(CubeMesh(1)), in_both);
  ExpectRefusals("cube.msh", AsciiGmsh22(CubeMesh(1)),
                 {{"2.2 0", "1.0 0", "cube.msh:2:1: Gmsh format '1.0' is not read"},
                  {"1 0 0 0", "1 0 inf 0", "a coordinate: 'inf' is not a finite number"},
                  {"1 0 0 0", "2 0 0 0", "node tag 2 is given twice"},
                  {"1 4 2 7 1 1 2", "1 5 2 7 1 1 2", "elements of type 5 (hexahedron) are not"},
                  {"1 4 2 7 1 1 2", "1 4 2 7 1 1 9", "names node 9, which does not exist"},
                  {"$Elements\n6", "$Elements\n7", "'$EndElements' is not an integer"},
                  {"$Elements\n6", "$Elements\n5", "expected $EndElements"}});
  ExpectRefusals("cube.msh", AsciiGmsh41(CubeMesh(1)),
                 {{"$Nodes\n1 8", "$Nodes\n1 9", "the blocks hold 8 nodes instead of 9"},
                  {"$Nodes\n1 8", "$Nodes\n1 7", "the nodes of a block: 8 is outside 0 to 7"},
                  {"$Elements\n2 6", "$Elements\n2 7", "fewer elements than $Elements says"},
                  {"3 1 4 6", "3 1 6 6", "elements of type 6 (prism) are not read"},
                  {"3 1 4 6", "2 1 4 6", "does not fit dimension 2"}});
}

}  // namespace
}  // namespace palpate::fem
