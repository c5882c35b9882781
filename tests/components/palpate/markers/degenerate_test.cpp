// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <cmath>

#include "components/palpate/find_robot.hpp"
#include "libs/core/file.hpp"
#include "tests/components/palpate/markers/marked_bar.hpp"

/// Markers with names that do not tell, or cannot be: what `palpate calibrate` says to them.
namespace palpate::command {
namespace {

using testing::AnyOf;
using testing::HasSubstr;

using DegenerateMarkers = MarkedBar;

TEST_F(DegenerateMarkers, WhatIsWellTellsAll) {
  RecordThree({});
  const ProgramRun run = Calibrate();
  ASSERT_EQ(run.exit_code, 0) << run.output;
  ExpectPose();
  EXPECT_NEAR(Found().drives.at(0).drive.offset_m, kOffset_m, 1e-4);
  EXPECT_TRUE(Found().undetermined.empty());
}

TEST_F(DegenerateMarkers, OnOneLineAreRefused) {
  RecordThree({.spoil = [](const Eigen::Vector3d& p) { return Eigen::Vector3d(p.x(), 0.3, 0.5); }});
  ExpectFailure(Calibrate(), "on one line");
}

/// They lie on a line at rest, and bend by little.
TEST_F(DegenerateMarkers, NearlyOnOneLineTellNoTurnAboutIt) {
  std::vector<Eigen::Vector3d> places_m;
  for (const double x_m : {0.01, 0.03, 0.05, 0.065, 0.08}) places_m.emplace_back(x_m, 0.01, 0.02);
  robot_ = WriteRobot(places_m);
  truth_ = LoadRobot(robot_, {});
  for (const char* name : {"a", "b"}) Record({.name = name, .commanded_m = 0.0});
  ExpectFailure(Calibrate(), "too near to one line for their errors");
}

TEST_F(DegenerateMarkers, AllOnTheFixedPartTellThePoseAndNothingOfTheDrive) {
  robot_ = WriteRobot({{0.0, 0.0, 0.0}, {0.0, 0.02, 0.0}, {0.0, 0.02, 0.02}, {0.0, 0.004, 0.017}});
  truth_ = LoadRobot(robot_, {});
  RecordThree({});
  const ProgramRun run = Calibrate();
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const robot::CalibrationFile file = Found();
  ASSERT_EQ(file.undetermined.size(), 2U) << run.output;
  EXPECT_THAT(file.undetermined[0].name, HasSubstr("top"));
  EXPECT_THAT(file.undetermined[1].name, HasSubstr("youngs_modulus"));
  EXPECT_TRUE(Found().drives.empty());
  EXPECT_THAT(run.output, HasSubstr("is not determined by these data"));
}

TEST_F(DegenerateMarkers, OneFrameDoesNotTellAGain) {
  Record({.name = "hold", .commanded_m = 0.005});
  const ProgramRun run = Calibrate({"--actuator-gains"});
  ASSERT_EQ(run.exit_code, 0) << run.output;
  ExpectPose();
  ASSERT_EQ(Found().undetermined.size(), 1U) << run.output;
  EXPECT_THAT(Found().undetermined[0].name, HasSubstr("gain"));
}

TEST_F(DegenerateMarkers, WithoutMotionTheGainIsNotTold) {
  for (const char* name : {"a", "b", "c"}) Record({.name = name, .commanded_m = 0.0});
  const ProgramRun run = Calibrate({"--actuator-gains"});
  ASSERT_EQ(run.exit_code, 0) << run.output;
  ExpectPose();
  EXPECT_THAT(run.output, HasSubstr("gain"));
  EXPECT_THAT(run.output, HasSubstr("is not determined by these data"));
}

TEST_F(DegenerateMarkers, MirroredOnesAreRefused) {
  RecordThree(
      {.spoil = [](const Eigen::Vector3d& p) { return Eigen::Vector3d(-p.x(), p.y(), p.z()); }});
  ExpectFailure(Calibrate(), "mirror");
}

TEST_F(DegenerateMarkers, OfAnotherRobotAreRefused) {
  RecordThree({});
  std::vector<Eigen::Vector3d> others_m = Twelve();
  std::swap(others_m[0], others_m[10]);
  std::swap(others_m[2], others_m[7]);
  robot_ = WriteRobot(others_m, "other.yaml");
  ExpectFailure(Calibrate(), "another robot");
}

TEST_F(DegenerateMarkers, NamesThatTheRobotDoesNotHaveAreRefusedWithTheLine) {
  RecordThree({});
  const auto file = folder_ / "data/recordings/hold_5/markers.csv";
  std::string text = ReadFile(file);
  text.replace(text.find(",m3,"), 4, ",n3,");
  WriteFile(file, text);
  const ProgramRun run = Calibrate();
  EXPECT_EQ(run.exit_code, 2) << run.output;
  EXPECT_THAT(run.output, HasSubstr("markers.csv:5:5"));
  EXPECT_FALSE(HasFile());
}

TEST_F(DegenerateMarkers, NotANumberIsRefusedWithTheLine) {
  RecordThree({.spoil = [](const Eigen::Vector3d& p) {
    return Eigen::Vector3d(p.x(), std::nan(""), p.z());
  }});
  const ProgramRun run = Calibrate();
  EXPECT_EQ(run.exit_code, 2) << run.output;
  EXPECT_THAT(run.output, HasSubstr("markers.csv:2:"));
  EXPECT_FALSE(HasFile());
}

TEST_F(DegenerateMarkers, PicturesMayShowDifferentOnes) {
  Record({.name = "a", .commanded_m = 0.002, .markers = {0, 3, 5, 8, 11}});
  Record({.name = "b", .commanded_m = 0.005, .markers = {1, 2, 6}});
  Record({.name = "c", .commanded_m = 0.008});
  const ProgramRun run = Calibrate();
  ASSERT_EQ(run.exit_code, 0) << run.output;
  ExpectPose();
  EXPECT_NEAR(Found().drives.at(0).drive.offset_m, kOffset_m, 2e-4);
}

TEST_F(DegenerateMarkers, TwoOfThemAreTooFew) {
  Record({.name = "a", .commanded_m = 0.005, .markers = {0, 7}});
  ExpectFailure(Calibrate(), "needs 3 points, there are 2");
}

}  // namespace
}  // namespace palpate::command
