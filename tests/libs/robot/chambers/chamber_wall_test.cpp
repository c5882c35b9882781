// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <utility>

#include "libs/core/error.hpp"
#include "libs/fem/mesh_io/stl_reader.hpp"
#include "libs/geometry/closed_surface.hpp"
#include "tests/libs/robot/chambers/hollow_robot.hpp"

namespace palpate::robot {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// 40 x 10 x 4 mm.
constexpr double kHollow_m3 = 1.6e-6;

using ChamberWalls = HollowRobotTest;

std::string One(const std::string& surface) {
  return "chambers: [{name: a, surface: {" + surface + "}}]\n";
}

TEST_F(ChamberWalls, AreFoundByGroupSkinAndFile) {
  for (const std::string surface :
       {"physical_group: upper wall", "inner_skin: 2", "file: upper.stl"}) {
    const RobotBody body = BodyOf(Text(One(surface)));
    ASSERT_EQ(body.chambers.size(), 1U);
    EXPECT_NEAR(body.chambers[0].volume_m3, kHollow_m3, 1e-6 * kHollow_m3) << surface;
  }
}

TEST_F(ChamberWalls, OfAFilePressTheBodyAsThoseOfTheMesh) {
  const auto tip = [&](const std::string& surface) {
    const auto model = Build(Text(One(surface)));
    fem::StaticState state = model->RestState();
    EXPECT_TRUE(model->Solve({{}, Pressure(*model, 1, 3e3)}, {}, &state).status.ok());
    return fem::PointLocator(model->body().mesh)
        .Embed({0.06, 0.01, 0.01})
        .weights.Position(state.x_m)
        .eval();
  };
  // Faces of the file stay flat between corners, those of the mesh bend.
  const Eigen::Vector3d moved_m = tip("inner_skin: 2") - Eigen::Vector3d(0.06, 0.01, 0.01);
  EXPECT_LE((tip("file: upper.stl") - tip("inner_skin: 2")).norm(), 0.02 * moved_m.norm());
}

TEST_F(ChamberWalls, AreReadWithAllTheirKeys) {
  const RobotBody body = BodyOf(Text());
  ASSERT_EQ(body.chambers.size(), 2U);
  EXPECT_EQ(body.chambers[0].name, "upper");
  EXPECT_EQ(body.chambers[0].dead_volume_m3, 1e-6);
  EXPECT_EQ(body.chambers[0].max_pressure_Pa, 20e3);
  EXPECT_EQ(body.chambers[1].dead_volume_m3, 0.0);
  EXPECT_EQ(body.chambers[1].max_pressure_Pa, 100e3);
  const RobotDescription read = ReadText(Text(), folder_ / "robot.yaml");
  const RobotDescription again =
      ReadText(FormatRobotFile(read, folder_.path()), folder_ / "robot.yaml");
  EXPECT_EQ(again.chambers[0].surface.physical_group, "upper wall");
  EXPECT_EQ(again.chambers[1].surface.inner_skin, 1);
  EXPECT_EQ(again.chambers[0].max_pressure_Pa, 20e3);
}

TEST_F(ChamberWalls, RefuseSettingsThatNameNoWall) {
  EXPECT_THAT(Refusal(Text(One(""))),
              HasSubstr("needs one of inner_skin, physical_group and file"));
  EXPECT_THAT(Refusal(Text(One("inner_skin: 1, file: upper.stl"))), HasSubstr("needs one of"));
  EXPECT_THAT(Refusal(Text(One("inner_skin: 0"))), HasSubstr("robot.yaml:9:"));
  EXPECT_THAT(Refusal(Text("chambers: [{name: top, surface: {inner_skin: 1}}]\n")),
              HasSubstr("the name 'top' is given twice"));
  EXPECT_THAT(
      Refusal(Text("chambers: [{name: a, surface: {inner_skin: 1}, max_pressure_kPa: 1}]\n")),
      HasSubstr("max_pressure_Pa"));
}

TEST_F(ChamberWalls, RefuseWhatTheMeshDoesNotHave) {
  EXPECT_THAT(Refusal(Text(One("inner_skin: 3"))),
              AllOf(HasSubstr("robot.yaml:9:"), HasSubstr("chamber a"),
                    HasSubstr("2 closed inner surfaces")));
  EXPECT_THAT(Refusal(Text(One("physical_group: uper wall"))),
              AllOf(HasSubstr("no group of triangles 'uper wall'"),
                    HasSubstr("did you mean 'upper wall'")));
  EXPECT_THAT(Refusal(Text(One("file: nowhere.stl"))), HasSubstr("surface file not found"));
}

TEST_F(ChamberWalls, RefuseBadGeometryWithThePlace) {
  EXPECT_THAT(Refusal(Text(One("physical_group: open wall"))),
              AllOf(HasSubstr("robot.yaml:9:"), HasSubstr("is open at the edge from ("),
                    HasSubstr("close it")));
  EXPECT_THAT(Refusal(Text(One("physical_group: skin"))), HasSubstr("is an outer surface"));
  EXPECT_THAT(Refusal(Text(One("physical_group: inside"))),
              AllOf(HasSubstr("material on both sides"), HasSubstr("the triangle of nodes")));
}

TEST_F(ChamberWalls, RefuseBadFilesWithThePlace) {
  geometry::TriangleSurface inward = UpperWall_mm();
  inward.triangles.row(0).swap(inward.triangles.row(1));
  WriteStl(inward, folder_ / "bad.stl");
  EXPECT_THAT(Refusal(Text(One("file: bad.stl"))), HasSubstr("turned inside out"));

  geometry::TriangleSurface mixed = UpperWall_mm();
  std::swap(mixed.triangles(0, 4), mixed.triangles(1, 4));
  WriteStl(mixed, folder_ / "bad.stl");
  EXPECT_THAT(Refusal(Text(One("file: bad.stl"))), HasSubstr("turned opposite ways"));

  geometry::TriangleSurface open = UpperWall_mm();
  open.triangles = open.triangles.leftCols(open.triangles.cols() - 1).eval();
  WriteStl(open, folder_ / "bad.stl");
  EXPECT_THAT(Refusal(Text(One("file: bad.stl"))), HasSubstr("is open at the edge"));

  geometry::TriangleSurface elsewhere = UpperWall_mm();
  elsewhere.vertices_m.row(1).array() += 40.0;
  WriteStl(elsewhere, folder_ / "bad.stl");
  EXPECT_THAT(Refusal(Text(One("file: bad.stl"))), HasSubstr("mm from every wall of the mesh"));

  // Pulled through the opposite side, which lies on the wall, too.
  geometry::TriangleSurface folded = UpperWall_mm();
  for (auto vertex : folded.vertices_m.colwise()) {
    if (vertex == Eigen::Vector3d(30, 10, 16)) vertex.z() = 11.9;
  }
  WriteStl(folded, folder_ / "bad.stl");
  EXPECT_THAT(Refusal(Text(One("file: bad.stl"))), HasSubstr("cut each other"));

  std::ofstream(folder_ / "bad.stl") << "something else";
  EXPECT_THAT(Refusal(Text(One("file: bad.stl"))), HasSubstr("is no STL"));
  std::ofstream(folder_ / "bad.stl") << "solid\nvertex 1 2\nendsolid\n";
  EXPECT_THAT(Refusal(Text(One("file: bad.stl"))),
              AllOf(HasSubstr("bad.stl:2"), HasSubstr("three finite numbers")));
}

TEST(Stl, IsReadAsTextToo) {
  const TestFolder folder;
  std::ofstream(folder / "a.stl") << "solid one\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n"
                                     "vertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";
  const geometry::TriangleSurface surface = fem::ReadStl(folder / "a.stl", 1e-3);
  EXPECT_EQ(surface.TriangleCount(), 1);
  EXPECT_EQ(surface.Corner(0, 1), Eigen::Vector3d(1e-3, 0.0, 0.0));
}

TEST_F(ChamberWalls, RefuseAWallOfTwoChambersWithItsPlace) {
  EXPECT_THAT(Refusal(Text(R"(chambers:
  - {name: upper, surface: {physical_group: upper wall}}
  - {name: again, surface: {inner_skin: 2}}
)")),
              testing::AllOf(HasSubstr("robot.yaml:11:28:"),
                             HasSubstr("chamber 'again' has the wall of chamber 'upper', as at ("),
                             HasSubstr("a hollow is one chamber")));
}

}  // namespace
}  // namespace palpate::robot
