// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/solve_verb.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>

#include "components/palpate/find_robot.hpp"
#include "components/palpate/solve_rows.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/experiment/csv_table.hpp"
#include "libs/experiment/markers.hpp"
#include "libs/fem/mesh_io/read_mesh.hpp"
#include "tests/components/palpate/test_robot.hpp"

namespace palpate::command {
namespace {

using experiment::CsvTable;
using test_support::MessageOf;

class SolveVerb : public testing::Test {
 protected:
  SolveVerb() {
    options_.robot = WriteBarRobot(folder_);
    options_.out = folder_ / "out";
  }

  void Actuate(const std::string& csv) { options_.actuation = folder_.Write("a.csv", csv); }
  nlohmann::json Result() const {
    return nlohmann::json::parse(ReadFile(options_.out / "result.json"));
  }
  CsvTable Cables() const { return CsvTable::Read(options_.out / "cables.csv"); }
  double TipHeight_m(int row) const {
    const CsvTable nodes =
        CsvTable::Read(options_.out / ("nodes_000" + std::to_string(row) + ".csv"));
    return nodes.Number(nodes.rows() - 1, 3);
  }

  TestFolder folder_;
  SolveOptions options_;
};

TEST_F(SolveVerb, WritesNodesCablesAndResult) {
  Actuate("t_s,top.tension_N\n0,0\n1,0.2\n");
  ASSERT_EQ(Solve(options_), 0);
  const CsvTable nodes = CsvTable::Read(options_.out / "nodes_0001.csv");
  EXPECT_EQ(nodes.header(), (std::vector<std::string>{"node", "x_m", "y_m", "z_m"}));
  EXPECT_EQ(nodes.rows(), 81U);
  EXPECT_EQ(Cables().header(),
            (std::vector<std::string>{"row", "cable", "displacement_m", "tension_N"}));
  const nlohmann::json result = Result();
  EXPECT_TRUE(result["converged"]);
  ASSERT_EQ(result["rows"].size(), 2U);
  for (const auto& row : result["rows"]) {
    EXPECT_EQ(row["status"], "ok");
    EXPECT_GT(row["iterations"], 0);
    EXPECT_LT(row["residual_N"], 1e-8);
    EXPECT_GE(row["time_s"], 0.0);
  }
  EXPECT_FALSE(std::filesystem::exists(options_.out / "body_0000.vtu"));
}

TEST_F(SolveVerb, GivesTheTensionBackForItsDisplacement) {
  Actuate("t_s,top.tension_N\n0,0.3\n");
  ASSERT_EQ(Solve(options_), 0);
  const double displacement_m = Cables().Number(0, 2);
  EXPECT_GT(displacement_m, 1e-4);
  const double height_m = TipHeight_m(0);
  Actuate("t_s,top.displacement_m\n0," + std::to_string(displacement_m) + "\n");
  ASSERT_EQ(Solve(options_), 0);
  EXPECT_NEAR(Cables().Number(0, 2), displacement_m, 1e-6);
  EXPECT_NEAR(Cables().Number(0, 3), 0.3, 2e-3);  // the displacement is written to 1e-6 m
  EXPECT_NEAR(TipHeight_m(0), height_m, 1e-4);
}

TEST_F(SolveVerb, SaysThatACableIsSlackAndNeverPushes) {
  Actuate("t_s,top.displacement_m\n0,-0.02\n");
  ASSERT_EQ(Solve(options_), 0);
  EXPECT_DOUBLE_EQ(Cables().Number(0, 3), 0.0);
  EXPECT_GT(Cables().Number(0, 2), -0.02);
  EXPECT_THAT(Result()["rows"][0]["notes"][0].get<std::string>(),
              testing::HasSubstr("cable top is slack"));
}

TEST_F(SolveVerb, FailsWithRowCableAndCauseWhereNoEquilibriumReachesTheDisplacement) {
  Actuate("t_s,top.displacement_m\n0,0.001\n1,0.2\n2,0.001\n");
  EXPECT_EQ(Solve(options_), 1);
  const nlohmann::json rows = Result()["rows"];
  EXPECT_FALSE(Result()["converged"]);
  EXPECT_TRUE(rows[0]["converged"]);
  EXPECT_EQ(rows[1]["status"], "not_converged");
  EXPECT_THAT(rows[1]["message"].get<std::string>(),
              testing::HasSubstr("cable top: no equilibrium reaches a displacement of 0.2 m"));
  EXPECT_TRUE(rows[2]["converged"]);
  EXPECT_FALSE(std::filesystem::exists(options_.out / "nodes_0001.csv"));
  EXPECT_TRUE(std::filesystem::exists(options_.out / "nodes_0002.csv"));
  EXPECT_EQ(Cables().Text(1, 2), "");
  EXPECT_NEAR(Cables().Number(2, 2), Cables().Number(0, 2), 1e-8);
}

TEST_F(SolveVerb, FailsWhereADisplacementNeedsMoreThanTheCableBears) {
  Actuate("t_s,top.displacement_m\n0,0.06\n");
  EXPECT_EQ(Solve(options_), 1);
  EXPECT_THAT(Result()["rows"][0]["message"].get<std::string>(), testing::HasSubstr("cable top"));
}

TEST_F(SolveVerb, HangsUnderItsWeightWithoutActuationAndLowerUnderALoad) {
  ASSERT_EQ(Solve(options_), 0);
  const double under_weight_m = TipHeight_m(0);
  EXPECT_LT(under_weight_m, 0.02);
  options_.loads = folder_.Write("l.csv",
                                 "t_s,x_m,y_m,z_m,fx_N,fy_N,fz_N,patch_radius_m\n"
                                 "0,0.08,0.01,0.01,0,0,-0.05,0.005\n");
  ASSERT_EQ(Solve(options_), 0);
  EXPECT_LT(TipHeight_m(0), under_weight_m - 1e-4);
}

TEST_F(SolveVerb, ReachesTheSameStateInOneStepAndInMany) {
  Actuate("t_s,top.displacement_m\n0,0.002\n");
  ASSERT_EQ(Solve(options_), 0);
  const double at_once_m = TipHeight_m(0);
  Actuate("t_s,top.displacement_m\n0,0\n1,0.0008\n2,0.0016\n3,0.002\n");
  ASSERT_EQ(Solve(options_), 0);
  EXPECT_NEAR(TipHeight_m(3), at_once_m, 1e-9);
}

TEST_F(SolveVerb, RemovesTheRowsOfAnEarlierRun) {
  Actuate("t_s,top.tension_N\n0,0\n1,0.1\n");
  options_.vtu = options_.png = true;
  ASSERT_EQ(Solve(options_), 0);
  EXPECT_TRUE(std::filesystem::exists(options_.out / "body_0001.vtu"));
  EXPECT_TRUE(std::filesystem::exists(options_.out / "scene_0001.png"));
  folder_.Write("out/mine.txt", "not ours");
  options_.actuation.clear();
  options_.vtu = options_.png = false;
  ASSERT_EQ(Solve(options_), 0);
  EXPECT_FALSE(std::filesystem::exists(options_.out / "nodes_0001.csv"));
  EXPECT_FALSE(std::filesystem::exists(options_.out / "body_0001.vtu"));
  EXPECT_FALSE(std::filesystem::exists(options_.out / "scene_0001.png"));
  EXPECT_TRUE(std::filesystem::exists(options_.out / "mine.txt"));
}

TEST_F(SolveVerb, RefusesALoadFarFromTheBodyWithFileAndLine) {
  options_.loads =
      folder_.Write("l.csv", "t_s,x_m,y_m,z_m,fx_N,fy_N,fz_N\n0,0.8,0.1,0.1,0,0,-0.05\n");
  try {
    Solve(options_);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("l.csv:2"));
    EXPECT_THAT(error.what(), testing::HasSubstr("half its diagonal"));
  }
}

TEST_F(SolveVerb, SaysWhereItCannotWriteBeforeItReadsTheRobot) {
  options_.robot = "no_such_robot";
  options_.out = folder_.Write("file", "in the way");
  EXPECT_THAT(MessageOf([&] { Solve(options_); }), testing::HasSubstr("is not a folder"));
}

TEST_F(SolveVerb, WritesMarkersAsARecordingHasThem) {
  Actuate("t_s,top.displacement_m\n0,0.001\n1,0.2\n2.5,0.002\n");
  EXPECT_EQ(Solve(options_), 1);  // the second row
  const auto markers = experiment::ReadMarkers(options_.out / "markers.csv");
  EXPECT_EQ(markers.names, std::vector<std::string>{"tip"});
  ASSERT_EQ(markers.frames.size(), 2U);
  EXPECT_EQ(markers.frames[1].t_s, 2.5);
  // The marker is the node at (80, 10, 20) mm: three nodes before the last.
  const CsvTable nodes = CsvTable::Read(options_.out / "nodes_0002.csv");
  for (int axis = 0; axis < 3; ++axis) {
    const auto column = static_cast<std::size_t>(axis) + 1;
    EXPECT_NEAR((*markers.frames[1].positions_m[0])[axis], nodes.Number(nodes.rows() - 4, column),
                1e-12);
  }
}

TEST_F(SolveVerb, LeavesFilesThatItDidNotWrite) {
  Actuate("t_s,top.tension_N\n0,0\n");
  ASSERT_EQ(Solve(options_), 0);
  folder_.Write("out/nodes_0009.csv", "mine");
  ASSERT_EQ(Solve(options_), 0);
  EXPECT_EQ(ReadFile(options_.out / "nodes_0009.csv"), "mine");
  folder_.Write("out/nodes_0001.csv", "mine, too");
  Actuate("t_s,top.tension_N\n0,0\n1,0\n");
  EXPECT_THAT(MessageOf([&] { Solve(options_); }),
              testing::AllOf(testing::HasSubstr("nodes_0001.csv: is there already"),
                             testing::HasSubstr("give another --out")));
  EXPECT_TRUE(std::filesystem::exists(options_.out / "nodes_0000.csv"));
}

TEST_F(SolveVerb, LeavesAResultThatIsOfSomethingElse) {
  folder_.Write("out/result.json", "{\"files\": [\"../bar.yaml\"]}");
  EXPECT_THAT(MessageOf([&] { Solve(options_); }), testing::HasSubstr("result.json: is there"));
  folder_.Write("out/result.json", R"({"palpate": "1", "files": ["../bar.yaml", "result.json"]})");
  ASSERT_EQ(Solve(options_), 0);
  EXPECT_TRUE(std::filesystem::exists(options_.robot));
}

TEST_F(SolveVerb, ParaViewHasUndeformedPointsWithFieldsAndTheTimes) {
  options_.loads = folder_.Write("l.csv",
                                 "t_s,x_m,y_m,z_m,fx_N,fy_N,fz_N\n"
                                 "0,0.08,0.01,0.02,0,0,-0.01\n2,0.08,0.01,0.02,0,0,-0.02\n");
  options_.vtu = true;
  ASSERT_EQ(Solve(options_), 0);
  const fem::TetMesh written = fem::ReadMesh(options_.out / "body_0001.vtu", 1.0);
  const fem::TetMesh rest = fem::ReadMesh(folder_ / "bar.vtk", 1e-3);
  EXPECT_TRUE(written.nodes_m.isApprox(rest.nodes_m, 1e-12));
  const std::string text = ReadFile(options_.out / "body_0001.vtu");
  for (const char* field :
       {"displacement_m", "load_N", "von_mises_stress_Pa", "largest_principal_strain"}) {
    EXPECT_THAT(text, testing::HasSubstr("Name=\"" + std::string(field) + "\""));
  }
  EXPECT_THAT(
      ReadFile(options_.out / "body.pvd"),
      testing::AllOf(testing::HasSubstr("timestep=\"0\" part=\"0\" file=\"body_0000.vtu\""),
                     testing::HasSubstr("timestep=\"2\" part=\"0\" file=\"body_0001.vtu\""),
                     testing::HasSubstr("timestep=\"2\" part=\"1\" file=\"cables_0001.vtu\"")));
  const std::string cables = ReadFile(options_.out / "cables_0001.vtu");
  EXPECT_THAT(cables, testing::HasSubstr("NumberOfCells=\"1\""));
  for (const char* field : {"displacement_m", "tension_N", "cable_displacement_m"}) {
    EXPECT_THAT(cables, testing::HasSubstr("Name=\"" + std::string(field) + "\""));
  }
}

TEST_F(SolveVerb, SaysHowFarATensionWasFollowedAndWhatToPrescribeInstead) {
  const std::string strong = std::regex_replace(
      ReadFile(options_.robot), std::regex("max_tension_N: 1"), "max_tension_N: 100");
  options_.robot = folder_.Write("strong.yaml", strong);
  Actuate("t_s,top.tension_N\n0,60\n");
  EXPECT_EQ(Solve(options_), 1);
  EXPECT_THAT(
      Result()["rows"][0]["message"].get<std::string>(),
      testing::AllOf(testing::ContainsRegex("cable top: followed up to [0-9.]+ N of the 60 N"),
                     testing::HasSubstr("prescribe the displacement (top.displacement_m)")));
}

TEST_F(SolveVerb, WarnsOfAModulusInAnotherUnit) {
  const std::string soft = std::regex_replace(
      ReadFile(options_.robot), std::regex("youngs_modulus_Pa: 100.0e3"), "youngs_modulus_Pa: 0.2");
  options_.robot = folder_.Write("soft.yaml", soft);
  testing::internal::CaptureStderr();
  LoadRobot(options_.robot);
  EXPECT_THAT(
      testing::internal::GetCapturedStderr(),
      testing::HasSubstr("warning: robot bar: material: youngs_modulus_Pa: 0.2 Pa is softer "
                         "than any solid: is this MPa? Then write 200000"));
}

TEST_F(SolveVerb, TellsTheWatcherOfEachRowAndLeavesOffWhereItGivesUp) {
  const auto model = LoadRobot(options_.robot);
  std::vector<LoadCase> rows(3);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].t_s = static_cast<double>(i);
    rows[i].cables = {{robot::ActuatorCommand::Kind::kTension, 0.1 * static_cast<double>(i)}};
  }
  std::vector<int> taken;
  std::vector<int> watched;
  const auto take = [&](const RowResult& result) { taken.push_back(result.row); };
  EXPECT_FALSE(SolveRows(rows, model.get(), take, [&](int row, const fem::StaticResult& so_far) {
    EXPECT_GE(so_far.load_fraction, 0.0);
    watched.push_back(row);
    return row < 1;
  }));
  EXPECT_EQ(taken, std::vector<int>{0});
  EXPECT_EQ(watched.back(), 1);
  EXPECT_TRUE(
      SolveRows(rows, model.get(), take, [](int, const fem::StaticResult&) { return true; }));
  EXPECT_EQ(taken, (std::vector<int>{0, 0, 1, 2}));
}

TEST_F(SolveVerb, RefusesARobotThatIsNotThere) {
  options_.robot = "four_legs";
  try {
    Solve(options_);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("did you mean 'four_leg'?"));
  }
  options_.robot = "no/such/robot.yaml";
  EXPECT_THROW(Solve(options_), InputError);
}

}  // namespace
}  // namespace palpate::command
