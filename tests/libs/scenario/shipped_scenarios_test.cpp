// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <cmath>
#include <set>
#include <sstream>

#include "libs/core/file.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/recording.hpp"
#include "libs/robot/robot_description.hpp"
#include "libs/scenario/effect_places.hpp"
#include "libs/scenario/robot_names.hpp"
#include "tests/libs/scenario/scenario_text.hpp"

namespace palpate::scenario {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::filesystem::path kSource = PALPATE_SOURCE_DIR;

Scenario Shipped(const std::string& name) {
  return ReadScenario(kSource / "config/scenarios" / (name + ".yaml"), app::LoadYaml);
}

RobotNames Robot(const std::string& name) {
  return NamesOf(robot::ReadRobotFile(kSource / "config/robots" / (name + ".yaml"), app::LoadYaml));
}
RobotNames FourLegNames() { return Robot("four_leg"); }

std::set<std::string> KindsOf(const Scenario& scenario) {
  std::set<std::string> kinds;
  for (const RecordingPlan& plan : scenario.recordings) kinds.insert(plan.kind);
  return kinds;
}

TEST(ShippedScenarios, PushesIsForFourLegAndHasItInView) {
  const Scenario scenario = Shipped("pushes");
  EXPECT_EQ(scenario.name, "pushes");
  EXPECT_NO_THROW(CheckAgainst(scenario, FourLegNames()));
  ASSERT_TRUE(scenario.camera && scenario.markers);
  const Eigen::Isometry3d T_camera_robot = scenario.camera->T_robot_camera.inverse();
  EXPECT_NEAR((T_camera_robot * Eigen::Vector3d(0, 0, 0.06)).norm(), 0.45, 0.02);
  const rgbd::CameraModel& depth = scenario.camera->camera.depth;
  for (const double x : {-0.1, 0.1}) {
    for (const double z : {0.0, 0.125}) {
      const Eigen::Vector2d pixel = rgbd::Project(depth, T_camera_robot * Eigen::Vector3d(x, x, z));
      EXPECT_TRUE(pixel.x() > 0 && pixel.x() < depth.width_px && pixel.y() > 0 &&
                  pixel.y() < depth.height_px)
          << pixel.transpose();
    }
  }
}

TEST(ShippedScenarios, PushesRestsPushesAtOneAndTwoPlacesAndPulls) {
  const Scenario scenario = Shipped("pushes");
  ASSERT_EQ(scenario.recordings.size(), 4u);
  EXPECT_EQ(scenario.recordings[0].kind, "rest");
  EXPECT_TRUE(scenario.recordings[0].tool_paths.empty());
  EXPECT_EQ(scenario.recordings[1].tool_paths.size(), 1u);
  EXPECT_EQ(scenario.recordings[2].tool_paths.size(), 2u);
  EXPECT_TRUE(scenario.recordings[3].tool_paths.empty());
  EXPECT_GT(scenario.recordings[3].commands.At(6.0).minCoeff(), 0.0);
  EXPECT_EQ(scenario.recordings[3].commands.cables.size(), 4u);
  EXPECT_TRUE(scenario.effects.empty());
}

TEST(ShippedScenarios, IdentifyHasEveryKindOfRecordingThatTellsCausesApart) {
  const Scenario scenario = Shipped("identify");
  EXPECT_NO_THROW(CheckAgainst(scenario, FourLegNames()));
  EXPECT_FALSE(scenario.camera);
  EXPECT_TRUE(scenario.markers);
  EXPECT_EQ(scenario.clutter, 1.0);
  EXPECT_THAT(KindsOf(scenario), ElementsAre("base_tilted", "co_contraction", "hold", "known_load",
                                             "ramp", "repeat", "rest", "second_speed"));
  EXPECT_EQ(scenario.recordings.front().kind, "rest");
  EXPECT_EQ(scenario.recordings.back().kind, "rest");
}

TEST(ShippedScenarios, DiagnoseRodIsForTheRodAndDoesWhatDiagnoseDoes) {
  const Scenario scenario = Shipped("diagnose_rod");
  EXPECT_NO_THROW(CheckAgainst(scenario, Robot("rod")));
  EXPECT_TRUE(scenario.effects.empty());
  EXPECT_EQ(scenario.clutter, 1.0);
  EXPECT_EQ(KindsOf(scenario), KindsOf(Shipped("diagnose")));
}

TEST(ShippedScenarios, KindsAreThoseOfAnExperiment) {
  using experiment::RecordingKind;
  for (int i = 0; i <= static_cast<int>(RecordingKind::kFree); ++i) {
    const std::string word = experiment::ToString(static_cast<RecordingKind>(i));
    EXPECT_EQ(Parse("name: s\nrecordings: [{name: a, duration_s: 1, kind: " + word + "}]\n")
                  .recordings[0]
                  .kind,
              word);
  }
}

std::string TableRow(const EffectKind& kind) {
  std::string row = "| `" + std::string(kind.id) + "` | `" + DescribePlace(kind.place) + "` | ";
  for (const EffectParameter& parameter : kind.parameters) {
    if (&parameter != &kind.parameters.front()) row += "<br>";
    row += "`" + std::string(parameter.name) + "` ";
    row += std::isnan(parameter.healthy) ? "robot's" : FormatNumber(parameter.healthy);
    if (parameter.tolerance > 0.0) row += " +- " + FormatNumber(parameter.tolerance);
    row += ", " + FormatNumber(parameter.min) + " to " + FormatNumber(parameter.max);
    if (!parameter.required) row += ", may be left out";
  }
  return row + " | " + std::string(kind.what) + " |\n";
}

TEST(ScenarioReadme, HoldsTheCatalogueAsItIs) {
  std::string table = "| id | where | parameters | what |\n|---|---|---|---|\n";
  for (const EffectKind& kind : EffectCatalogue()) table += TableRow(kind);
  EXPECT_THAT(ReadFile(kSource / "libs/scenario/README.md"), HasSubstr(table));
}

}  // namespace
}  // namespace palpate::scenario
