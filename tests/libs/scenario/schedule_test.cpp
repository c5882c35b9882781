// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/scenario/schedule.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "libs/core/error.hpp"

namespace palpate::scenario {
namespace {

CommandRow Row(double t_s, double north_m) { return {t_s, Eigen::VectorXd::Constant(1, north_m)}; }

/// 2 s of rest, 4 s with a ramp of "north" to 8 mm, a tool and a weight; 2 s of rest, 1 s tilted.
Scenario TwoRecordings() {
  Scenario scenario;
  scenario.rest_between_s = 2.0;
  RecordingPlan ramp;
  ramp.name = "ramp";
  ramp.duration_s = 4.0;
  ramp.commands = {{"north"}, {Row(0.0, 0.0), Row(4.0, 0.008)}};
  Waypoint waypoint;
  waypoint.T_robot_tool.translation() = Eigen::Vector3d(0.1, 0.2, 0.3);
  ramp.tool_paths = {{"ball", {waypoint}}};
  ramp.weights = {{1.0, Eigen::Vector3d::Zero(), 0.05, 0.0},
                  {3.0, Eigen::Vector3d::UnitX(), 0.02, 0.0}};
  RecordingPlan tilted;
  tilted.name = "tilted";
  tilted.base_tilt_deg = Eigen::Vector2d(10.0, 0.0);
  scenario.recordings = {ramp, tilted};
  scenario.tools = {Tool{}};
  scenario.tools[0].name = "ball";
  return scenario;
}

TEST(Schedule, RecordingsFollowEachOtherWithRestsBetween) {
  const Schedule schedule(TwoRecordings(), {"west", "north"});
  EXPECT_DOUBLE_EQ(schedule.Duration_s(), 9.0);
  EXPECT_DOUBLE_EQ(schedule.Begin_s(1), 8.0);
  EXPECT_EQ(schedule.At(0.0).recording, 0);
  EXPECT_DOUBLE_EQ(schedule.At(0.0).t_s, -2.0);
  EXPECT_DOUBLE_EQ(schedule.At(2.0).t_s, 0.0);
  EXPECT_EQ(schedule.At(5.999).recording, 0);
  EXPECT_EQ(schedule.At(6.0).recording, 1);
  EXPECT_DOUBLE_EQ(schedule.At(6.0).t_s, -2.0);
  EXPECT_EQ(schedule.At(100.0).recording, 1);
  EXPECT_DOUBLE_EQ(schedule.At(100.0).t_s, 1.0);
}

TEST(Schedule, CommandsComeInTheOrderOfTheRobotsCables) {
  const Schedule schedule(TwoRecordings(), {"west", "north"});
  const BenchInputs inputs = schedule.InputsAt(4.0);
  EXPECT_TRUE(std::isnan(inputs.displacement_m[0]));
  EXPECT_DOUBLE_EQ(inputs.displacement_m[1], 0.004);
}

TEST(Schedule, CommandsGoBackToZeroInTheFirstHalfOfARest) {
  const Schedule schedule(TwoRecordings(), {"north"});
  EXPECT_DOUBLE_EQ(schedule.InputsAt(1.0).displacement_m[0], 0.0);
  EXPECT_DOUBLE_EQ(schedule.InputsAt(6.0).displacement_m[0], 0.008);
  EXPECT_NEAR(schedule.InputsAt(6.5).displacement_m[0], 0.004, 1e-12);
  EXPECT_DOUBLE_EQ(schedule.InputsAt(7.5).displacement_m[0], 0.0);
  EXPECT_TRUE(std::isnan(schedule.InputsAt(8.5).displacement_m[0]));
}

TEST(Schedule, ToolsAndWeightsAreThereInTheirRecordingOnly) {
  const Schedule schedule(TwoRecordings(), {"north"});
  EXPECT_TRUE(schedule.InputsAt(1.0).tools.empty());
  ASSERT_EQ(schedule.InputsAt(2.5).tools.size(), 1u);
  EXPECT_DOUBLE_EQ(schedule.InputsAt(2.5).tools[0].T_robot_tool.translation().z(), 0.3);
  EXPECT_TRUE(schedule.InputsAt(2.5).weights.empty());
  ASSERT_EQ(schedule.InputsAt(4.0).weights.size(), 1u);
  EXPECT_DOUBLE_EQ(schedule.InputsAt(4.0).weights[0].mass_kg, 0.05);
  ASSERT_EQ(schedule.InputsAt(5.5).weights.size(), 1u);
  EXPECT_DOUBLE_EQ(schedule.InputsAt(5.5).weights[0].mass_kg, 0.02);
  EXPECT_TRUE(schedule.InputsAt(7.0).weights.empty());
}

TEST(Schedule, TheBaseIsTiltedDuringTheRestBefore) {
  const Schedule schedule(TwoRecordings(), {"north"});
  EXPECT_DOUBLE_EQ(schedule.InputsAt(5.0).base_tilt_deg.x(), 0.0);
  EXPECT_NEAR(schedule.InputsAt(7.0).base_tilt_deg.x(), 5.0, 1e-12);
  EXPECT_DOUBLE_EQ(schedule.InputsAt(8.5).base_tilt_deg.x(), 10.0);
}

TEST(Schedule, RefusesACableThatTheRobotDoesNotHave) {
  EXPECT_THROW(Schedule(TwoRecordings(), {"nort"}), InputError);
}

}  // namespace
}  // namespace palpate::scenario
