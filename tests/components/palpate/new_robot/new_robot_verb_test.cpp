// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/new_robot/new_robot_verb.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "components/palpate/info_verb.hpp"
#include "components/palpate/solve_verb.hpp"
#include "components/palpate/system/system_file.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/file.hpp"
#include "libs/experiment/csv_table.hpp"
#include "libs/robot/robot_body.hpp"
#include "libs/robot/robot_description.hpp"
#include "libs/scenario/robot_names.hpp"
#include "libs/scenario/scenario.hpp"
#include "tests/components/palpate/new_robot/drawn_mesh.hpp"

namespace palpate::command {
namespace {

using Eigen::Vector3d;
using test::Bar;
using test::DrawnGroup;
using test::WriteMsh;
using test_support::MessageOf;
using test_support::TestFolder;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class NewRobotVerb : public testing::Test {
 protected:
  NewRobotVerb() { options_.out = folder_ / "robot"; }

  /// A finger of 100 x 20 x 20 mm along x, its fixed end at x = 0.
  void DrawFinger(const std::vector<DrawnGroup>& groups = {}) {
    options_.mesh = WriteMsh(folder_, "finger.msh", Bar({100, 20, 20}, {8, 2, 2}), groups);
  }

  int Run(const std::string& answers) {
    std::istringstream stream(answers);
    testing::internal::CaptureStdout();
    try {
      const int code = NewRobot(options_, &stream);
      output_ = testing::internal::GetCapturedStdout();
      return code;
    } catch (...) {
      output_ = testing::internal::GetCapturedStdout();
      throw;
    }
  }
  int Run() {
    options_.yes = true;
    return Run("");
  }

  robot::RobotDescription Written() const {
    return robot::ReadRobotFile(options_.out / "robot.yaml", app::LoadYaml);
  }

  TestFolder folder_;
  NewRobotOptions options_;
  std::string output_;
};

TEST_F(NewRobotVerb, WritesARobotThatInfoAndSolveTake) {
  DrawFinger();
  options_.known.cables = {"up=-10,10,15;98,10,15"};
  ASSERT_EQ(Run(), 0) << output_;
  const robot::RobotDescription robot = Written();
  EXPECT_EQ(robot.name, "finger");
  EXPECT_EQ(robot.mesh.metres_per_unit, 1e-3);
  ASSERT_EQ(robot.cables.size(), 1U);
  EXPECT_GE(robot.cables[0].path_m.cols(), 4);
  EXPECT_EQ(robot.markers.size(), 8U);
  const robot::RobotBody body = robot::BuildRobotBody(robot);
  EXPECT_TRUE(body.warnings.empty()) << body.warnings[0];
  EXPECT_EQ(Info({.target = options_.out / "robot.yaml", .unit = {}, .png = {}}), 0);
  SolveOptions solve;
  solve.robot = options_.out / "robot.yaml";
  solve.actuation = options_.out / "actuation.csv";
  solve.out = folder_ / "solved";
  EXPECT_EQ(Solve(solve), 0);
  EXPECT_GT(std::filesystem::file_size(options_.out / "robot.png"), 10000U);
}

TEST_F(NewRobotVerb, TakesCablesInAUnitOfTheirOwn) {
  DrawFinger();
  options_.known.unit = "mm";
  options_.known.cables = {"clicked=0.0000,0.0100,0.0200;0.0500,0.0100,0.0200;0.1,0.0100,0.0150 m",
                           "blanks=0, 1, 1; 5, 1, 1 ; 10, 1, 1  cm",
                           "file=0,10,0;50,10,0;100,10,5"};
  ASSERT_EQ(Run(), 0) << output_;
  const robot::RobotDescription robot = Written();
  ASSERT_EQ(robot.cables.size(), 3U);
  Eigen::Matrix3d clicked_m, blanks_m, file_m;
  clicked_m << 0.0, 0.05, 0.1, 0.01, 0.01, 0.01, 0.02, 0.02, 0.015;
  blanks_m << 0.0, 0.05, 0.1, 0.01, 0.01, 0.01, 0.01, 0.01, 0.01;
  file_m << 0.0, 0.05, 0.1, 0.01, 0.01, 0.01, 0.0, 0.0, 0.005;
  EXPECT_TRUE(robot.cables[0].path_m.isApprox(clicked_m, 1e-9)) << robot.cables[0].path_m;
  EXPECT_TRUE(robot.cables[1].path_m.isApprox(blanks_m, 1e-9)) << robot.cables[1].path_m;
  EXPECT_TRUE(robot.cables[2].path_m.isApprox(file_m, 1e-9)) << robot.cables[2].path_m;
  EXPECT_THAT(output_, HasSubstr("Cables by clicks on the body: palpate view "));
}

TEST_F(NewRobotVerb, RefusesAnUnknownUnitOfACable) {
  DrawFinger();
  options_.known.cables = {"up=0,1,1;4,1,1 inch"};
  EXPECT_THAT(MessageOf([&] { Run(); }), HasSubstr("'inch' is no unit: m, cm or mm"));
  EXPECT_FALSE(std::filesystem::exists(options_.out));
}

TEST_F(NewRobotVerb, SaysEachGuessWithItsReasonAndMarksItInTheFile) {
  DrawFinger();
  ASSERT_EQ(Run(), 0);
  EXPECT_THAT(output_, AllOf(HasSubstr("unit: mm\n    likely: the body is 100 long"),
                             HasSubstr("up: z\n    guess: no mesh says it"),
                             HasSubstr("fixed: flat face at x = 0 mm"), HasSubstr("alike"),
                             HasSubstr("--fixed changes it"), HasSubstr("cables: none"),
                             HasSubstr("palpate calibrate")));
  const std::string text = ReadFile(options_.out / "robot.yaml");
  EXPECT_THAT(text, AllOf(HasSubstr("guess: both flat ends"), HasSubstr("# cables:"),
                          HasSubstr("guess: Dragon Skin 10 by its data sheet")));
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 120U) << line;
}

TEST_F(NewRobotVerb, TakesTheAnswersOfItsQuestionsAndAsksAgainForWhatCannotBe) {
  options_.mesh = WriteMsh(folder_, "finger.msh", Bar({10, 2, 2}, {8, 2, 2}));
  ASSERT_EQ(
      Run("inches\nmm\n\nx_mid\nx_max\necoflex_00_30\npull=11,1,1;0,1,6\npull=11,1,1;0,1,1.5\n\n"),
      0)
      << output_;
  const robot::RobotDescription robot = Written();
  EXPECT_EQ(robot.mesh.metres_per_unit, 1e-3);
  EXPECT_NEAR(robot.fixed.at(0).lower_m.x(), 0.01, 1e-4);
  EXPECT_EQ(robot.cables.at(0).name, "pull");
  EXPECT_NEAR(robot.material.youngs_modulus_Pa, 118e3, 1.0);
  EXPECT_THAT(output_, AllOf(HasSubstr("unit: cm (guess"), HasSubstr("'inches' is no unit"),
                             HasSubstr("there is no such group"), HasSubstr("outside the body")));
}

TEST_F(NewRobotVerb, TakesTheGuessesWhereTheAnswersEnd) {
  DrawFinger();
  EXPECT_EQ(Run("mm\n"), 0) << output_;
  EXPECT_EQ(Written().mesh.metres_per_unit, 1e-3);
}

TEST_F(NewRobotVerb, TurnsGravityWithUp) {
  DrawFinger();
  options_.known.up = "minus_z";
  ASSERT_EQ(Run(), 0);
  EXPECT_TRUE(Written().gravity_m_s2.isApprox(Vector3d(0, 0, 9.81)));
}

TEST_F(NewRobotVerb, OverwritesNothingWithoutForce) {
  DrawFinger();
  ASSERT_EQ(Run(), 0);
  WriteFile(options_.out / "robot.yaml", "mine");
  EXPECT_THAT(MessageOf([&] { Run(); }), HasSubstr("exists already; --force"));
  EXPECT_EQ(ReadFile(options_.out / "robot.yaml"), "mine");
  options_.force = true;
  EXPECT_EQ(Run(), 0);
  EXPECT_EQ(Written().name, "finger");
}

TEST_F(NewRobotVerb, DoesNotReplaceAnotherMeshOfThatName) {
  DrawFinger();
  folder_.Write("robot/finger.msh", "another");
  EXPECT_THAT(MessageOf([&] { Run(); }), HasSubstr("another mesh of this name"));
  EXPECT_FALSE(std::filesystem::exists(options_.out / "robot.yaml"));
}

TEST_F(NewRobotVerb, KeepsTheMeshWhereTheFolderIsItsOwn) {
  DrawFinger();
  const std::string before = ReadFile(options_.mesh);
  options_.out = folder_.path();
  EXPECT_EQ(Run(), 0);
  EXPECT_EQ(ReadFile(options_.mesh), before);
}

TEST_F(NewRobotVerb, WritesNothingWhereACableIsOffTheBody) {
  DrawFinger();
  options_.known.cables = {"up=0,10,10;98,10,60"};
  EXPECT_THAT(MessageOf([&] { Run(); }), HasSubstr("40 mm outside the body"));
  EXPECT_FALSE(std::filesystem::exists(options_.out));
}

TEST_F(NewRobotVerb, WarnsOfACableThatCannotPull) {
  DrawFinger();
  options_.known.cables = {"dead=-10,10,10;0,10,10"};
  options_.known.fixed = {"x_min"};
  EXPECT_EQ(Run(), 1);
  EXPECT_THAT(output_, HasSubstr("warning: cable dead"));
}

TEST_F(NewRobotVerb, TakesTenNodeElementsAndNamedCables) {
  const fem::TetMesh bar = fem::MakeQuadratic(Bar({0.1, 0.02, 0.02}, {5, 2, 2}));
  fem::TetMesh in_gmsh_order = bar;
  in_gmsh_order.cells.row(8) = bar.cells.row(9);
  in_gmsh_order.cells.row(9) = bar.cells.row(8);
  const auto near = [](double x, double y) {
    return [x, y](const Vector3d& at) { return (at - Vector3d(x, y, 0.02)).norm() < 1e-6; };
  };
  options_.mesh = WriteMsh(folder_, "bar.msh", in_gmsh_order,
                           {{.name = "cable_1", .dimension = 0, .holds = near(0.0, 0.01)},
                            {.name = "cable_2", .dimension = 0, .holds = near(0.1, 0.01)},
                            {.name = "marker_tip", .dimension = 0, .holds = near(0.1, 0.02)}});
  ASSERT_EQ(Run(), 0) << output_;
  const robot::RobotDescription robot = Written();
  EXPECT_EQ(robot.mesh.metres_per_unit, 1.0);
  ASSERT_EQ(robot.cables.size(), 1U);
  EXPECT_EQ(robot.cables[0].name, "cable");
  ASSERT_EQ(robot.markers.size(), 1U);
  EXPECT_EQ(robot.markers[0].name, "marker_tip");
}

TEST_F(NewRobotVerb, RefusesSurfacesWithTheCommandsThatFillThem) {
  options_.mesh = folder_.Write("body.stl", "solid body\nendsolid\n");
  EXPECT_THAT(MessageOf([&] { Run(); }),
              AllOf(HasSubstr("STL surface"), HasSubstr("Merge \"body.stl\""),
                    HasSubstr("gmsh -3 body.geo"), HasSubstr("palpate new-robot body.msh")));
  options_.mesh = folder_.Write("body.ply", "ply\nformat ascii 1.0\nend_header\n");
  EXPECT_THAT(MessageOf([&] { Run(); }), HasSubstr("Merge \"body.ply\""));
  options_.mesh = folder_.Write("body.step", "ISO-10303-21;\n");
  EXPECT_THAT(MessageOf([&] { Run(); }), HasSubstr("gmsh -3 body.step -clmax SIZE"));
  options_.mesh = folder_.Write("body.yaml", "name: body\n");
  EXPECT_THAT(MessageOf([&] { Run(); }), HasSubstr("palpate info checks it"));
  options_.mesh = folder_ / "absent.msh";
  EXPECT_THAT(MessageOf([&] { Run(); }), HasSubstr("mesh file not found"));
  fem::TetMesh none = Bar({100, 20, 20}, {5, 2, 2});
  const DrawnGroup skin{.name = "skin", .holds = [](const Vector3d&) { return true; }};
  std::string text = ReadFile(WriteMsh(folder_, "skin.msh", none, {skin}));
  // Tetrahedra become points: a surface mesh.
  for (std::size_t at; (at = text.find(" 4 2 0 1 ")) != std::string::npos;) {
    const std::size_t nodes = at + 9, end = text.find(' ', nodes);
    text.replace(at, text.find('\n', end) - at, " 15 2 0 1 " + text.substr(nodes, end - nodes));
  }
  options_.mesh = folder_.Write("skin.msh", text);
  EXPECT_THAT(MessageOf([&] { Run(); }), HasSubstr("holds no tetrahedron: fill the surface"));
  EXPECT_FALSE(std::filesystem::exists(options_.out));
}

TEST_F(NewRobotVerb, WritesAScenarioAndASystemForThatRobot) {
  DrawFinger();
  options_.known.cables = {"up=-10,10,15;98,10,15", "down=-10,10,5;98,10,5"};
  ASSERT_EQ(Run(), 0);
  const auto scenario = scenario::ReadScenario(options_.out / "rehearsal.yaml", app::LoadYaml);
  EXPECT_EQ(scenario.recordings.size(), 8U);
  EXPECT_TRUE(scenario.camera.has_value());
  const auto effects = scenario::DrawEffects(scenario, scenario::NamesOf(Written()), 1);
  EXPECT_EQ(effects.size(), 2U);
  const auto table = experiment::CsvTable::Read(options_.out / "actuation.csv");
  EXPECT_EQ(table.header(),
            (std::vector<std::string>{"t_s", "up.displacement_m", "down.displacement_m"}));
  EXPECT_EQ(table.rows(), 3U);
  const SystemFile system = ReadSystemFile(options_.out / "live.yaml", app::LoadYaml);
  ASSERT_EQ(system.hosts.size(), 1U);
  EXPECT_EQ(system.hosts[0].processes.size(), 6U);
}

TEST_F(NewRobotVerb, SuggestsAsManyMarkersAsAskedForAwayFromTheFixedEnd) {
  DrawFinger();
  options_.known.markers = 3;
  ASSERT_EQ(Run(), 0);
  const auto markers = Written().markers;
  ASSERT_EQ(markers.size(), 3U);
  for (const auto& marker : markers) EXPECT_GT(marker.position_m.x(), 0.0);
  options_.force = true;
  options_.known.markers = 0;
  ASSERT_EQ(Run(), 0);
  EXPECT_TRUE(Written().markers.empty());
  EXPECT_THAT(output_, HasSubstr("--camera-pose"));
}

}  // namespace
}  // namespace palpate::command
