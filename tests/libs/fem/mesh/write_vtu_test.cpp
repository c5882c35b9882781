// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/mesh_io/write_vtu.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "libs/core/error.hpp"
#include "libs/fem/mesh_io/read_mesh.hpp"
#include "tests/libs/fem/mesh/mesh_files.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::fem {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string TextOf(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

std::string FailureToWrite(const TetMesh& mesh, const std::filesystem::path& file) {
  try {
    WriteVtu(file, mesh, mesh.nodes_m.reshaped());
  } catch (const RunError& error) {
    return error.what();
  }
  return "";
}

TEST(WriteVtu, WritesWhatReadMeshReadsBackExactly) {
  const test_support::TestFolder folder;
  // The large one has more bytes of coordinates than one block of the compressor.
  for (const TetMesh& mesh :
       {test::CubeMesh(3), MakeQuadratic(test::CubeMesh(3)), test::CubeMesh(36)}) {
    TetMesh deformed = mesh;
    deformed.nodes_m = (mesh.nodes_m.array() + 0.1 * mesh.nodes_m.array().square()).matrix() / 3.0;
    for (const VtuEncoding encoding : {VtuEncoding::kCompressed, VtuEncoding::kAscii}) {
      const auto file = folder.path() / "out.vtu";
      WriteVtu(file, mesh, deformed.nodes_m.reshaped(), {}, encoding);
      EXPECT_TRUE(test::SameMesh(ReadMesh(file, 1.0), deformed));
    }
  }
}

TEST(WriteVtu, WritesFieldsOfNodesAndCells) {
  const test_support::TestFolder folder;
  const TetMesh mesh = test::CubeMesh(1);
  const VtuFields fields = {.of_nodes = {{"displacement_m", Eigen::MatrixXd::Constant(3, 8, 0.125)},
                                         {"a<b & \"c\"", Eigen::RowVectorXd::LinSpaced(8, 0, 7)}},
                            .of_cells = {{"stress_Pa", Eigen::RowVectorXd::LinSpaced(6, 0, 5)}}};
  const auto file = folder.path() / "out.vtu";
  WriteVtu(file, mesh, mesh.nodes_m.reshaped(), fields, VtuEncoding::kAscii);
  const std::string text = TextOf(file);
  const auto point_data = text.substr(text.find("<PointData>"), text.find("<CellData>"));
  EXPECT_THAT(point_data, AllOf(HasSubstr("Name=\"displacement_m\" NumberOfComponents=\"3\""),
                                HasSubstr("Name=\"a&lt;b &amp; &quot;c&quot;\""),
                                HasSubstr("\n0 1 2 3 4 5 6 7 \n")));
  EXPECT_THAT(text.substr(text.find("<CellData>")),
              AllOf(HasSubstr("Name=\"stress_Pa\" NumberOfComponents=\"1\""),
                    HasSubstr("\n0 1 2 3 4 5 \n")));
  WriteVtu(file, mesh, mesh.nodes_m.reshaped(), fields);
  EXPECT_TRUE(test::SameMesh(ReadMesh(file, 1.0), mesh));
}

TEST(WriteVtu, WritesPolylinesOneAfterTheOther) {
  const test_support::TestFolder folder;
  const auto file = folder.path() / "lines.vtu";
  const std::vector<Eigen::Matrix3Xd> lines_m = {Eigen::Matrix3Xd::Zero(3, 2),
                                                 Eigen::Matrix3Xd::Constant(3, 3, 0.5)};
  WriteVtuLines(file, lines_m,
                {.of_nodes = {}, .of_cells = {{"tension_N", Eigen::Vector2d(3, 4).transpose()}}},
                VtuEncoding::kAscii);
  EXPECT_THAT(TextOf(file), AllOf(HasSubstr("NumberOfPoints=\"5\" NumberOfCells=\"2\""),
                                  HasSubstr("\n0 0 0 0 0 0 0.5 0.5 0.5 0.5 0.5 0.5 0.5 0.5 0.5 \n"),
                                  HasSubstr("\n0 1 2 3 4 \n"), HasSubstr("\n2 5 \n"),
                                  HasSubstr("\n4 4 \n"), HasSubstr("\n3 4 \n")));
}

TEST(WriteVtu, SaysWhereItCannotWrite) {
  const test_support::TestFolder folder;
  EXPECT_THAT(FailureToWrite(test::CubeMesh(1), folder.path() / "none" / "out.vtu"),
              AllOf(HasSubstr("none/out.vtu: cannot be written"), HasSubstr("No such file")));
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  // The small one fits the buffer, so that only closing the file shows that the disk is full.
  for (const TetMesh& mesh : {test::CubeMesh(1), test::CubeMesh(8)}) {
    EXPECT_THAT(FailureToWrite(mesh, "/dev/full"), HasSubstr("No space left"));
  }
}

}  // namespace
}  // namespace palpate::fem
