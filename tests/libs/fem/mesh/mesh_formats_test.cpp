// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lz4.h>
#include <lzma.h>

#include <algorithm>
#include <sstream>

#include "libs/core/index.hpp"
#include "libs/fem/mesh_io/base64.hpp"
#include "libs/fem/mesh_io/packing.hpp"
#include "libs/fem/mesh_io/read_mesh.hpp"
#include "libs/fem/mesh_report.hpp"
#include "libs/fem/seams.hpp"
#include "tests/libs/fem/mesh/binary.hpp"
#include "tests/libs/fem/mesh/mesh_files.hpp"

namespace palpate::fem {
namespace {

using test::CubeMesh;
using test::ReadBytes;
using test::RefusalOf;
using test::Replaced;
using testing::ElementsAre;
using testing::HasSubstr;

std::string Lz4(const std::string& bytes) {
  std::string packed(static_cast<size_t>(LZ4_compressBound(static_cast<int>(bytes.size()))), '\0');
  packed.resize(static_cast<size_t>(LZ4_compress_default(bytes.data(), packed.data(),
                                                         static_cast<int>(bytes.size()),
                                                         static_cast<int>(packed.size()))));
  return packed;
}

std::string Lzma(const std::string& bytes) {
  std::string packed(lzma_stream_buffer_bound(bytes.size()), '\0');
  size_t size = 0;
  const lzma_ret result = lzma_easy_buffer_encode(
      6, LZMA_CHECK_CRC32, nullptr, reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size(),
      reinterpret_cast<uint8_t*>(packed.data()), &size, packed.size());
  EXPECT_EQ(result, LZMA_OK);
  packed.resize(size);
  return packed;
}

/// An array as VTK packs it, in blocks of 64 bytes, base64.
std::string PackedArray(const std::string& bytes, std::string (*pack)(const std::string&)) {
  constexpr size_t kBlock = 64;
  std::string header, data;
  const auto add = [&](size_t value) {
    header += test::Binary(static_cast<uint32_t>(value), false);
  };
  add((bytes.size() + kBlock - 1) / kBlock);
  add(kBlock);
  add(bytes.size() % kBlock);
  for (size_t start = 0; start < bytes.size(); start += kBlock) {
    const std::string packed = pack(bytes.substr(start, kBlock));
    add(packed.size());
    data += packed;
  }
  return mesh_io::EncodeBase64(header) + mesh_io::EncodeBase64(data);
}

std::string PackedVtu(const TetMesh& mesh, const std::string& compressor,
                      std::string (*pack)(const std::string&)) {
  std::string points, connectivity, offsets, types;
  for (const double x : mesh.nodes_m.reshaped()) points += test::Binary(x, false);
  for (const int node : mesh.cells.reshaped()) connectivity += test::Binary(int64_t{node}, false);
  for (int cell = 1; cell <= mesh.CellCount(); ++cell) {
    offsets += test::Binary(int64_t{4} * cell, false);
    types += test::Binary(uint8_t{10}, false);
  }
  const auto array = [&](const std::string& attributes, const std::string& bytes) {
    return "<DataArray format=\"binary\" " + attributes + ">" + PackedArray(bytes, pack) +
           "</DataArray>";
  };
  return "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\" compressor=\"" +
         compressor + "\"><UnstructuredGrid><Piece NumberOfPoints=\"" +
         std::to_string(mesh.NodeCount()) + "\" NumberOfCells=\"" +
         std::to_string(mesh.CellCount()) + "\"><Points>" +
         array("type=\"Float64\" NumberOfComponents=\"3\"", points) + "</Points><Cells>" +
         array("type=\"Int64\" Name=\"connectivity\"", connectivity) +
         array("type=\"Int64\" Name=\"offsets\"", offsets) +
         array("type=\"UInt8\" Name=\"types\"", types) +
         "</Cells></Piece></UnstructuredGrid></VTKFile>";
}

TEST(MeshFormats, VtuMayBePackedByLz4OrLzma) {
  const TetMesh mesh = CubeMesh(2);
  EXPECT_TRUE(
      test::SameMesh(ReadBytes({"m.vtu", PackedVtu(mesh, "vtkLZ4DataCompressor", Lz4)}), mesh));
  const std::string lzma = PackedVtu(mesh, "vtkLZMADataCompressor", Lzma);
  EXPECT_TRUE(test::SameMesh(ReadBytes({"m.vtu", lzma}), mesh));
  EXPECT_THAT(RefusalOf({"m.vtu", PackedVtu(mesh, "vtkLZ4DataCompressor", Lzma)}),
              HasSubstr("block 0 is damaged"));
  EXPECT_THAT(RefusalOf({"m.vtu", PackedVtu(mesh, "vtkBrotliCompressor", Lz4)}),
              HasSubstr("'vtkBrotliCompressor' is not read"));
}

TEST(MeshFormats, VtuMayHoldWhatXmlAllowsAroundItsNumbers) {
  const TetMesh mesh = CubeMesh(2);
  const std::string bytes = test::AsciiVtu(mesh);
  const std::string comment = "<!-- <DataArray>1 2</DataArray> --><Points";
  for (const std::string& file : {Replaced(bytes, "<Points", comment),
                                  Replaced(bytes, "</DataArray>", "<!-- a --></DataArray>"),
                                  Replaced(bytes, "</DataArray>", "&#32;</DataArray>"),
                                  Replaced(bytes, "<DataArray ", "<DataArray note=\"a>b\" ")}) {
    EXPECT_TRUE(test::SameMesh(ReadBytes({"m.vtu", file}), mesh)) << file;
  }
  std::string wrapped = PackedVtu(mesh, "vtkLZ4DataCompressor", Lz4);
  wrapped.insert(wrapped.find("</DataArray>") - 10, "\n ");
  EXPECT_TRUE(test::SameMesh(ReadBytes({"m.vtu", wrapped}), mesh));
  EXPECT_THAT(RefusalOf({"m.vtu", Replaced(bytes, "</DataArray>",
                                           " \x1A"
                                           "0</DataArray>")}),
              HasSubstr("is not"));
}

TEST(MeshFormats, VtuRefusalsCountTheLinesOfNumbersBefore) {
  std::string bytes = Replaced(test::AsciiVtu(CubeMesh(2)), "</DataArray>", "\n\n\n</DataArray>");
  const size_t start = bytes.find('>', bytes.find("Name=\"connectivity\"")) + 1;
  bytes.insert(start, "\n\n x ");
  const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(start) + 2;
  const auto line = std::count(bytes.begin(), place, '\n') + 1;
  EXPECT_THAT(RefusalOf({"m.vtu", bytes}),
              HasSubstr("m.vtu:" + std::to_string(line) + ": array 'connectivity': 'x'"));
}

TEST(MeshFormats, APackedBlockIsNeverLargerThanSoundOnesAre) {
  std::string out;
  EXPECT_FALSE(mesh_io::Unpack(mesh_io::Packing::kLz4, "abc", size_t{1} << 40, &out));
  EXPECT_FALSE(mesh_io::Unpack(mesh_io::Packing::kLzma, "abc", size_t{1} << 40, &out));
  EXPECT_LT(out.capacity(), 100u);
}

TEST(MeshFormats, TheFirstBytesDecideNotTheEnding) {
  const TetMesh mesh = CubeMesh(1);
  EXPECT_TRUE(test::SameMesh(ReadBytes({"xml.vtk", test::AsciiVtu(mesh)}), mesh));
  EXPECT_TRUE(test::SameMesh(ReadBytes({"legacy.vtu", test::AsciiVtk(mesh)}), mesh));
  EXPECT_TRUE(test::SameMesh(ReadBytes({"gmsh.mesh", test::AsciiGmsh22(mesh)}), mesh));
}

TEST(MeshFormats, LegacyFieldsMayHoldStringsBitsAndMetadata) {
  const TetMesh mesh = CubeMesh(1);
  const std::string field =
      "FIELD FieldData 3\nProducer 1 2 string\nour mesher, a line\nPOINTS 9 in a text\n\n"
      "METADATA\nINFORMATION 0\n\nflags 1 3 bit\n0 1 1\nTimeValue 1 1 double\n0.25\n";
  const std::string bytes = Replaced(test::AsciiVtk(mesh), "POINTS 8", field + "POINTS 8");
  EXPECT_TRUE(test::SameMesh(ReadBytes({"m.vtk", bytes}), mesh));
  EXPECT_THAT(RefusalOf({"m.vtk", Replaced(bytes, "2 string", "900 string")}),
              HasSubstr("too short for 900 strings"));
}

TEST(MeshFormats, LagrangeTetrahedraOfFourAndTenNodesAreTetrahedra) {
  const std::string bytes =
      "# vtk DataFile Version 4.2\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n"
      "0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n71\n";
  EXPECT_EQ(ReadBytes({"m.vtk", bytes}).cells, Eigen::Vector4i(0, 1, 2, 3));
  const std::string triangle =
      Replaced(Replaced(bytes, "1 5\n4 0 1 2 3", "1 4\n3 0 1 2"), "71", "69");
  EXPECT_THAT(RefusalOf({"m.vtk", triangle}), HasSubstr("no tetrahedron"));
}

TEST(MeshFormats, GmshVersionsTwoAreReadWhateverTheyCallThemselves) {
  const TetMesh mesh = CubeMesh(1);
  for (const std::string version : {"2", "2.0", "2.1", "2.000000"}) {
    const std::string bytes = Replaced(test::AsciiGmsh22(mesh), "2.2 0", version + " 0");
    EXPECT_TRUE(test::SameMesh(ReadBytes({"m.msh", bytes}), mesh)) << version;
  }
}

/// Two tetrahedra in two physical groups that overlap, as the two versions write them.
constexpr const char* kOverlapping22 =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n3 1 \"all\"\n3 2 \"top\"\n"
    "$EndPhysicalNames\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 0 0 -1\n$EndNodes\n"
    "$Elements\n3\n1 4 2 1 1 1 2 3 4\n2 4 2 1 1 1 3 2 5\n3 4 2 2 1 1 2 3 4\n$EndElements\n";

TEST(MeshFormats, AnElementOfTwoPhysicalGroupsCountsOnce) {
  const TetMesh mesh = ReadBytes({"m.msh", kOverlapping22});
  EXPECT_EQ(mesh.CellCount(), 2);
  EXPECT_THAT(mesh.groups, ElementsAre(CellGroup{"all", {0, 1}}, CellGroup{"top", {0}}));
  EXPECT_NEAR(ReportMesh(mesh).volume_m3, 1.0 / 3.0, 1e-15);
  EXPECT_TRUE(ReportMesh(mesh).duplicate_cells.empty());
}

TEST(MeshFormats, Gmsh40IsRead) {
  const TetMesh mesh = ReadBytes(
      {"m.msh",
       "$MeshFormat\n4 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 7 \"soft body\"\n"
       "$EndPhysicalNames\n$Entities\n1 0 0 1\n9 0 0 0 0 0 0 0\n1 0 0 0 1 1 1 1 7 0\n"
       "$EndEntities\n$Nodes\n1 4\n1 3 0 4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n"
       "$Elements\n1 1\n1 3 4 1\n1 1 2 3 4\n$EndElements\n"});
  EXPECT_EQ(mesh.cells, Eigen::Vector4i(0, 1, 2, 3));
  EXPECT_EQ(mesh.nodes_m.col(3), Eigen::Vector3d(0, 0, 1));
  EXPECT_THAT(mesh.groups, ElementsAre(CellGroup{"soft body", {0}}));
}

TEST(MeshFormats, PartitionsOfGmshAreReadTogether) {
  const TetMesh mesh = ReadBytes(
      {"m.msh",
       "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 7 \"soft body\"\n"
       "$EndPhysicalNames\n$Entities\n0 0 0 1\n1 0 0 0 1 1 1 1 7 0\n$EndEntities\n"
       "$PartitionedEntities\n2\n1\n5 1\n1 0 0 2\n3 0 1 1 1 0 0 0 0\n"
       "2 3 1 1 1 0 0 0 1 1 1 1 7 0\n3 3 1 1 2 0 0 0 1 1 1 0 0\n$EndPartitionedEntities\n"
       "$Nodes\n1 5 1 5\n3 2 0 5\n1\n2\n3\n4\n5\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 -1\n$EndNodes\n"
       "$Elements\n2 2 1 2\n3 2 4 1\n1 1 2 3 4\n3 3 4 1\n2 1 3 2 5\n$EndElements\n"});
  EXPECT_EQ(mesh.CellCount(), 2);
  EXPECT_NEAR(ReportMesh(mesh).volume_m3, 1.0 / 3.0, 1e-15);
  EXPECT_THAT(mesh.groups, ElementsAre(CellGroup{"soft body", {0, 1}}))
      << "the second has its parent's group";
}

constexpr const char* kAbaqus =
    "** made by hand\n*HEADING\nbar\n*NODE, NSET=ALL\n10, 0., 0., 0.\n20, 1., 0., 0.\n"
    "30, 0., 1., 0.\n40, 0., 0., 1.\n50, 0., 0., -1.\n*ELEMENT, TYPE=CPS3, ELSET=skin\n"
    "1, 10, 20, 30\n*Element, type=C3D4, elset=Volume1\n7, 10, 20, 30, 40\n8, 10,\n30, 20, 50\n"
    "*ELSET, ELSET=top\n7,\n*ELSET, ELSET=both, GENERATE\n7, 8, 1\n*NODE PRINT\nU\n";

TEST(MeshFormats, AbaqusGivesElementsAndTheirSets) {
  const TetMesh mesh = ReadBytes({"m.inp", kAbaqus});
  EXPECT_EQ(mesh.NodeCount(), 5);
  ASSERT_EQ(mesh.CellCount(), 2);
  EXPECT_EQ(mesh.cells.col(1), Eigen::Vector4i(0, 2, 1, 4));
  EXPECT_THAT(mesh.groups, ElementsAre(CellGroup{"Volume1", {0, 1}}, CellGroup{"both", {0, 1}},
                                       CellGroup{"top", {0}}));
  EXPECT_THAT(RefusalOf({"m.inp", Replaced(kAbaqus, "C3D4", "C3D8")}),
              HasSubstr("m.inp:12: elements of type 'C3D8' are not read"));
  EXPECT_THAT(RefusalOf({"m.inp", Replaced(kAbaqus, "30, 20, 50", "30, 20")}),
              HasSubstr("has 3 nodes instead of 4"));
  EXPECT_THAT(RefusalOf({"m.inp", Replaced(kAbaqus, "30, 20, 50", "30, 20, 60")}),
              HasSubstr("names node 60, which does not exist"));
  EXPECT_THAT(RefusalOf({"m.inp", "nothing\n"}), HasSubstr("no Abaqus input file"));
}

constexpr const char* kMedit =
    "MeshVersionFormatted 2\n# a comment\nDimension\n3\nVertices\n5\n0 0 0 1\n1 0 0 1\n0 1 0 1\n"
    "0 0 1 1\n0 0 -1 1\nTriangles\n1\n1 2 3 4\nTetrahedra\n2\n1 2 3 4 0\n1 3 2 5 6\nCorners\n2\n1 "
    "2\n"
    "End\n";

TEST(MeshFormats, MeditGivesTetrahedraAndTheirReferences) {
  const TetMesh mesh = ReadBytes({"m.mesh", kMedit});
  ASSERT_EQ(mesh.CellCount(), 2);
  EXPECT_EQ(mesh.cells.col(1), Eigen::Vector4i(0, 2, 1, 4));
  EXPECT_THAT(mesh.groups, ElementsAre(CellGroup{"6", {1}}));
  EXPECT_THAT(RefusalOf({"m.mesh", Replaced(kMedit, "1 3 2 5 6", "1 3 2 9 6")}),
              HasSubstr("9 is outside 1 to 5"));
  EXPECT_THAT(RefusalOf({"m.mesh", Replaced(kMedit, "3\nVertices", "2\nVertices")}),
              HasSubstr("only 3-D"));
}

/// As Gmsh 4.8 writes a mesh of second order.
TEST(MeshFormats, MeditWithTenNodesUnderTheKeywordOfFourIsRefused) {
  const std::string text =
      "MeshVersionFormatted 2\nDimension\n3\nVertices\n10\n"
      "0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1 1\n.5 0 0 1\n.5 .5 0 1\n0 .5 0 1\n0 0 .5 1\n"
      "0 .5 .5 1\n.5 0 .5 1\nTetrahedra\n1\n1 2 3 4 5 6 7 8 9 10 1\nEnd\n";
  EXPECT_THAT(RefusalOf({"m.mesh", text}),
              AllOf(HasSubstr("m.mesh:"), HasSubstr("save the mesh as .msh or .vtu")));
}

TEST(MeshFormats, MeditSectionsComeInAnyOrder) {
  const std::string text = kMedit;
  const size_t vertices = text.find("Vertices");
  const size_t others = text.find("Triangles");
  const size_t end = text.find("End");
  const std::string last = text.substr(0, vertices) + text.substr(others, end - others) +
                           text.substr(vertices, others - vertices) + "End\n";
  const TetMesh mesh = ReadBytes({"m.mesh", last});
  EXPECT_TRUE(test::SameMesh(mesh, ReadBytes({"m.mesh", text})));
  EXPECT_EQ(mesh.groups, ReadBytes({"m.mesh", text}).groups);
  EXPECT_THAT(RefusalOf({"m.mesh", Replaced(last, "1 3 2 5 6", "1 3 2 9 6")}),
              HasSubstr("9 is outside 1 to 5"));
}

TEST(MeshFormats, AbaqusKnowsFortransExponents) {
  const TetMesh mesh = ReadBytes({"m.inp", Replaced(kAbaqus, "20, 1.,", "20, 0.1D+01,")});
  EXPECT_TRUE(test::SameMesh(mesh, ReadBytes({"m.inp", kAbaqus})));
}

TEST(MeshFormats, RealsOfVtuCellDataNameGroupsWhereTheyAreWhole) {
  const TetMesh mesh = ReadBytes({"m.inp", kAbaqus});
  const auto with = [&](const std::string& values) {
    return Replaced(
        test::AsciiVtu(mesh), "</Cells>",
        "</Cells><CellData><DataArray type=\"Float64\" Name=\"region\" format=\"ascii\">" + values +
            "</DataArray></CellData>");
  };
  EXPECT_THAT(ReadBytes({"m.vtu", with("2.0 3")}).groups,
              ElementsAre(CellGroup{"region=2", {0}}, CellGroup{"region=3", {1}}));
  for (const char* none : {"0.5 3", "nan 1"}) {
    EXPECT_TRUE(ReadBytes({"m.vtu", with(none)}).groups.empty()) << none;
  }
}

TEST(MeshFormats, WholeNumbersInCellDataNameGroups) {
  const std::string vtk = test::AsciiVtk(CubeMesh(1)) +
                          "\nCELL_DATA 6\nSCALARS material int 1\nLOOKUP_TABLE default\n"
                          "1 1 2 2 2 1\nFIELD FieldData 1\nquality 1 6 double\n"
                          "0.5 0.5 0.5 0.5 0.5 0.5\n";
  const TetMesh mesh = ReadBytes({"m.vtk", vtk});
  EXPECT_THAT(mesh.groups,
              ElementsAre(CellGroup{"material=1", {0, 1, 5}}, CellGroup{"material=2", {2, 3, 4}}));
}

TEST(MeshFormats, CellDataNameGroupsWhateverStandsBeforeThem) {
  const std::string points = "\nPOINT_DATA 8\nSCALARS temperature double\nLOOKUP_TABLE heat\n" +
                             std::string("0 1 2 3 4 5 6 7\nLOOKUP_TABLE heat 1\n0.1 0.2 0.3 1\n") +
                             "VECTORS u float\n" + std::string(8, ' ') +
                             "0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 nan 0 0\n"
                             "SCALARS on bit 1\nLOOKUP_TABLE default\n0 1 0 1 0 1 0 1\n";
  const std::string cells =
      "CELL_DATA 6\nNORMALS n float\n0 0 1 0 0 1 0 0 1 0 0 1 0 0 1 0 0 1\n"
      "COLOR_SCALARS c 3\n0 0 1 0 0 1 0 0 1 0 0 1 0 0 1 0 0 1\n"
      "SCALARS part%20id%2 short\nLOOKUP_TABLE default\n1 1 2 2 2 1\n";
  const TetMesh mesh = ReadBytes({"m.vtk", test::AsciiVtk(CubeMesh(1)) + points + cells});
  EXPECT_THAT(mesh.groups, ElementsAre(CellGroup{"part id%2=1", {0, 1, 5}},
                                       CellGroup{"part id%2=2", {2, 3, 4}}));
  EXPECT_THAT(RefusalOf({"m.vtk", test::AsciiVtk(CubeMesh(1)) + "\nPOINT_DATA 7\n"}),
              HasSubstr("another number of points"));
}

TEST(MeshFormats, WhatAbaqusWritesElsewhereIsRefused) {
  const auto with = [](const std::string& line) {
    return RefusalOf(
        {"m.inp", Replaced(kAbaqus, "*ELSET, ELSET=top", line + "\n*ELSET, ELSET=top")});
  };
  EXPECT_THAT(with("*INSTANCE, NAME=i, PART=p\n1., 0., 0."), HasSubstr("moves its part"));
  EXPECT_THAT(with("*INCLUDE, INPUT=nodes.inp"), HasSubstr("names another file"));
  EXPECT_THAT(with("*ELSET, ELSET=a, INPUT=set.inp"), HasSubstr("names another file"));
  EXPECT_THAT(with("*NODE, SYSTEM=C\n60, 1., 90., 0."), HasSubstr("SYSTEM=C"));
  EXPECT_THAT(with("*NGEN\n1, 5"), HasSubstr("*NGEN is not read"));
}

TEST(MeshFormats, AbaqusSetsAreEqualInAnyCaseAndMayStandFirst) {
  const std::string early =
      "*ELSET, ELSET=Early,\n GENERATE\n7, 9\n*ELSET, ELSET=all\nTOP, EARLY\n";
  const TetMesh mesh = ReadBytes(
      {"m.inp", Replaced(Replaced(kAbaqus, "*ELEMENT, TYPE=CPS3", early + "*ELEMENT, TYPE=CPS3"),
                         "ELSET=both", "ELSET=VOLUME1")});
  EXPECT_THAT(mesh.groups, ElementsAre(CellGroup{"Early", {0, 1}}, CellGroup{"Volume1", {0, 1}},
                                       CellGroup{"all", {0, 1}}, CellGroup{"top", {0}}));
}

TEST(MeshFormats, NodesOfAnAbaqusAssemblyAreNoneOfTheBody) {
  const std::string part = "*PART, NAME=p\n" + std::string(kAbaqus) + "*END PART\n";
  const std::string assembly =
      "*ASSEMBLY, NAME=a\n*INSTANCE, NAME=i, PART=p\n*END INSTANCE\n*NODE\n10, 0., 0., 5.\n"
      "*ELEMENT, TYPE=MASS, ELSET=rp\n7, 10\n*ELSET, ELSET=i\n8,\n"
      "*ELSET, ELSET=end, INSTANCE=i\n8,\n*END ASSEMBLY\n";
  const TetMesh mesh = ReadBytes({"m.inp", part + assembly});
  EXPECT_EQ(mesh.NodeCount(), 5);
  EXPECT_THAT(mesh.groups, ElementsAre(CellGroup{"Volume1", {0, 1}}, CellGroup{"both", {0, 1}},
                                       CellGroup{"end", {1}}, CellGroup{"top", {0}}));
  EXPECT_THAT(RefusalOf({"m.inp", part + Replaced(assembly, "*NODE",
                                                  "*INSTANCE, NAME=j, PART=p\n*END INSTANCE\n"
                                                  "*NODE")}),
              HasSubstr("a second *INSTANCE"));
}

TEST(MeshFormats, NodesOfGmsh40HaveAParameterForEachDimension) {
  const TetMesh mesh = ReadBytes(
      {"m.msh",
       "$MeshFormat\n4 0 8\n$EndMeshFormat\n$Nodes\n3 4\n1 0 0 1\n1 0 0 0\n1 1 1 2\n2 1 0 0 0.5\n"
       "3 0 1 0 0.7\n1 2 1 1\n4 0 0 1 0.1 0.2\n$EndNodes\n$Elements\n1 1\n1 3 4 1\n1 1 2 3 4\n"
       "$EndElements\n"});
  EXPECT_NEAR(ReportMesh(mesh).volume_m3, 1.0 / 6.0, 1e-15);
}

TEST(MeshFormats, NodesOfGmsh2MayHaveParameters) {
  const TetMesh mesh =
      ReadBytes({"m.msh",
                 "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$ParametricNodes\n4\n1 0 0 0 0 1\n"
                 "2 1 0 0 1 4 0.5\n3 0 1 0 2 3 0.1 0.2\n4 0 0 1 3 1\n$EndParametricNodes\n"
                 "$Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n"});
  EXPECT_EQ(mesh.nodes_m.col(2), Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(mesh.nodes_m.col(3), Eigen::Vector3d(0, 0, 1));
}

TEST(MeshFormats, CommentsMayStandBeforeGmshsFormat) {
  const TetMesh mesh = CubeMesh(1);
  const std::string bytes = "$Comments\nmade by hand\n$EndComments\n" + test::AsciiGmsh22(mesh);
  EXPECT_TRUE(test::SameMesh(ReadBytes({"m.msh", bytes}), mesh));
  EXPECT_THAT(RefusalOf({"m.msh", "$NOD\n1\n1 0 0 0\n$ENDNOD\n"}), HasSubstr("Gmsh format 1"));
  const test_support::TestFolder folder;
  const auto marked =
      test::WriteMeshFile(folder, {"m.msh", "\xEF\xBB\xBF" + test::AsciiGmsh22(mesh)});
  EXPECT_TRUE(test::SameMesh(ReadMesh(marked, 1.0), mesh)) << "a byte order mark";
}

/// Two cubes side by side, each with nodes of its own at the seam.
TetMesh TwoCubes(int n, double gap_m) {
  const TetMesh one = CubeMesh(n);
  TetMesh two;
  two.nodes_m.resize(3, 2 * one.NodeCount());
  two.nodes_m << one.nodes_m, (one.nodes_m.colwise() + Eigen::Vector3d(1.0 + gap_m, 0, 0));
  two.cells.resize(4, 2 * one.CellCount());
  two.cells << one.cells, one.cells.array() + one.NodeCount();
  return two;
}

TEST(Seams, FacesThatLieOnEachOtherAreJoined) {
  for (const bool quadratic : {false, true}) {
    TetMesh mesh = TwoCubes(2, 1e-9);
    if (quadratic) mesh = MakeQuadratic(mesh);
    const double volume_m3 = ReportMesh(mesh).volume_m3;
    EXPECT_EQ(ReportMesh(mesh).pieces, 2);
    const std::vector<int> joined = JoinSeams(&mesh);
    EXPECT_EQ(joined.size(), quadratic ? 25u : 9u);
    const MeshReport report = ReportMesh(mesh);
    EXPECT_EQ(report.pieces, 1);
    EXPECT_EQ(report.parts, 1);
    EXPECT_EQ(report.unused_nodes, joined);
    EXPECT_EQ(report.overshared_faces, 0);
    EXPECT_NEAR(report.volume_m3, volume_m3, 1e-6);
  }
}

TEST(Seams, BodiesThatDoNotTouchOrMeetAlongAnEdgeStayApart) {
  TetMesh apart = TwoCubes(2, 1e-3);
  EXPECT_TRUE(JoinSeams(&apart).empty());
  TetMesh edge = TwoCubes(2, 0.0);
  edge.nodes_m.rightCols(edge.NodeCount() / 2).row(1).array() += 1.0;
  EXPECT_TRUE(JoinSeams(&edge).empty());
  TetMesh whole = CubeMesh(2);
  EXPECT_TRUE(JoinSeams(&whole).empty());
}

}  // namespace
}  // namespace palpate::fem
