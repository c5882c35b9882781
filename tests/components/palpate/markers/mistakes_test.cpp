// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "libs/app/child_process.hpp"
#include "libs/core/file.hpp"
#include "tests/components/palpate/markers/marked_bar.hpp"

/// What people do wrong: `palpate calibrate` says what it was, exits with 1 and writes nothing.
namespace palpate::command {
namespace {

using testing::HasSubstr;
using testing::Not;

class Mistakes : public MarkedBar {
 protected:
  void ExchangeLabels(const std::string& a, const std::string& b) const {
    for (const char* name : {"hold_2", "hold_5", "hold_8"}) {
      const std::string file = std::string("data/recordings/") + name + "/markers.csv";
      std::string text = ReadFile(folder_ / file);
      Replace("," + a + ",", ",?,", &text);
      Replace("," + b + ",", "," + a + ",", &text);
      Replace(",?,", "," + b + ",", &text);
      folder_.Write(file, text);
    }
  }
  static void Replace(const std::string& old, const std::string& by, std::string* text) {
    ASSERT_NE(text->find(old), std::string::npos) << old;
    text->replace(text->find(old), old.size(), by);
  }
  void MeasuredInTheRobotFrame() const {
    folder_.Write("data/experiment.yaml", "frame: robot\nmarkers_sigma_m: 1.0e-4\n");
  }
};

TEST_F(Mistakes, ExchangedLabelsAreNamedAndAnOlderFileIsKept) {
  RecordThree({});
  ExchangeLabels("m1", "m4");
  const auto file = folder_.Write("calibration.yaml", "an older calibration");
  const ProgramRun run = Calibrate();
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.output, HasSubstr("nothing was written. Likely reasons, the best first:"));
  EXPECT_THAT(run.output, HasSubstr("1. labels: the markers m1 and m4 have each other's names"));
  EXPECT_EQ(ReadFile(file), "an older calibration");
}

TEST_F(Mistakes, ExchangedLabelsAreNamedWhereThePoseIsKnown) {
  RecordThree({});
  ExchangeLabels("m1", "m4");
  TellPose(T_robot_camera_);
  ExpectFailure(Calibrate(), "1. labels: the markers m1 and m4 have each other's names");
}

TEST_F(Mistakes, Centimetres) {
  RecordThree({.spoil = [](const Eigen::Vector3d& seen_m) { return (100.0 * seen_m).eval(); }});
  ExpectFailure(Calibrate(), "are the columns x_m, y_m, z_m centimetres?");
}

TEST_F(Mistakes, AnotherSize) {
  RecordThree({.spoil = [](const Eigen::Vector3d& seen_m) { return (1.4 * seen_m).eval(); }});
  ExpectFailure(Calibrate(), "1. size: the sizes disagree: markers are");
}

TEST_F(Mistakes, AnAxisWithTheWrongSign) {
  RecordThree({.spoil = [](const Eigen::Vector3d& seen_m) {
    return Eigen::Vector3d(-seen_m.x(), seen_m.y(), seen_m.z());
  }});
  ExpectFailure(Calibrate(), "mirror image");
}

TEST_F(Mistakes, YUpInTheRobotFrame) {
  RecordThree({.spoil = [&](const Eigen::Vector3d& seen_m) {
    const Eigen::Vector3d robot_m = T_robot_camera_ * seen_m;
    return Eigen::Vector3d(robot_m.x() + 0.3, robot_m.z(), -robot_m.y());
  }});
  MeasuredInTheRobotFrame();
  const ProgramRun run = Calibrate();
  ExpectFailure(run, "1. pose, frame and axes: frame: robot puts the markers");
  EXPECT_THAT(run.output, HasSubstr("the robot's x is its x, y is its -z, z is its y"));
  EXPECT_THAT(run.output, HasSubstr("import the markers with --register"));
}

TEST_F(Mistakes, AShiftedRobotFrame) {
  RecordThree({.spoil = [&](const Eigen::Vector3d& seen_m) {
    return (T_robot_camera_ * seen_m + Eigen::Vector3d(0.1, 0.0, 0.0)).eval();
  }});
  MeasuredInTheRobotFrame();
  ExpectFailure(Calibrate(), "1. pose, frame and axes: frame: robot puts the markers 99.");
}

TEST_F(Mistakes, AnotherRobot) {
  RecordThree({});
  std::vector<Eigen::Vector3d> others = Twelve();
  for (std::size_t m = 0; m < others.size(); m += 2) others[m].x() = 0.08 - others[m].x();
  robot_ = WriteRobot(others);
  ExpectFailure(Calibrate(), "another robot");
}

TEST_F(Mistakes, AModulusInKilopascals) {
  RecordThree({});
  ChangeRobot("youngs_modulus_Pa: 100.0e3", "youngs_modulus_Pa: 100", false);
  EXPECT_THAT(Calibrate().output, HasSubstr("kPa or MPa"));
}

TEST_F(Mistakes, ALoadThatIsNotTold) {
  RecordThree({});
  Record({.name = "hold_9", .commanded_m = 0.004, .load_N = 0.2, .tell_load = false});
  ExpectFailure(Calibrate(), "load: hold_9 alone is");
}

TEST_F(Mistakes, AKnownLoadWithoutLoads) {
  RecordThree({});
  Record({.name = "hung",
          .commanded_m = 0.004,
          .load_N = 0.2,
          .tell_load = false,
          .kind = "known_load"});
  for (const char* what : {"auto", "material", "joint"}) {
    const ProgramRun run = Calibrate({"--what", what});
    EXPECT_EQ(run.exit_code, 2) << run.output;
    EXPECT_THAT(run.output, HasSubstr("hung/loads.csv: is missing"));
    EXPECT_THAT(run.output, HasSubstr("t_s,x_m,y_m,z_m,fx_N,fy_N,fz_N"));
    EXPECT_FALSE(HasFile());
  }
}

/// One rule for all verbs.
TEST_F(Mistakes, AKnownLoadOffTheBody) {
  RecordThree({});
  Record({.name = "hung", .commanded_m = 0.004, .load_N = 0.2, .kind = "known_load"});
  TellPose(T_robot_camera_);
  folder_.Write("data/recordings/hung/loads.csv",
                "t_s,x_m,y_m,z_m,fx_N,fy_N,fz_N\n0,0.08,0.01,0.06,0,0,-0.2\n");
  const std::string data = (folder_ / "data").string();
  const std::vector<ProgramRun> runs = {
      Calibrate(),
      Run({"estimate", robot_.string(), "--data", data, "--out",
           (folder_ / "forces.csv").string()}),
      Run({"diagnose", robot_.string(), "--data", data, "--out", (folder_ / "report").string()})};
  for (const ProgramRun& run : runs) {
    EXPECT_NE(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("hung/loads.csv:2:1: the load at (0.08, 0.01, 0.06) m lies "
                                      "0.04 m from the body's surface; at most 0.02 m is allowed"));
    EXPECT_THAT(run.output, HasSubstr("in metres"));
  }
  EXPECT_FALSE(HasFile());
  EXPECT_FALSE(std::filesystem::exists(folder_ / "forces.csv"));
}

/// Of a diagnosis that is interrupted a report is left, and nothing that another verb would take.
TEST_F(Mistakes, ADiagnosisThatIsInterrupted) {
  RecordThree({});
  TellPose(T_robot_camera_);
  const std::filesystem::path report = folder_ / "report";
  folder_.Write("report/robot.extended.yaml", "of an earlier diagnosis\n");
  app::ChildProcess process(PALPATE_BINARY_DIR "/bin/palpate",
                            {"diagnose", robot_.string(), "--data", (folder_ / "data").string(),
                             "--out", report.string()},
                            {}, folder_ / "log");
  // Past the first step of the search, not before the program reads what stops it.
  while (!process.ExitCode() &&
         ReadFile(folder_ / "log").find("simulating the nominal robot") == std::string::npos) {
    std::this_thread::yield();
  }
  process.Interrupt();
  EXPECT_EQ(process.Wait(), 130);
  const std::string log = ReadFile(folder_ / "log");
  EXPECT_THAT(log, HasSubstr("interrupted: the search ends, and what it found is written"));
  EXPECT_THAT(log, HasSubstr("interrupted during the search: the partial report is in"));
  EXPECT_THAT(ReadFile(report / "verdict.json"), HasSubstr("\"interrupted\": true"));
  EXPECT_THAT(ReadFile(report / "report.html"), HasSubstr("(interrupted, partial)"));
  EXPECT_FALSE(std::filesystem::exists(report / "robot.extended.yaml"));
}

TEST_F(Mistakes, AnOutputThatCannotBeWrittenIsSaidBeforeTheWork) {
  const std::string absent = (folder_ / "absent/file").string();
  std::vector<ProgramRun> runs = {
      Run({"calibrate", robot_.string(), "--data", (folder_ / "data").string(), "--out", absent})};
  for (const char* option : {"--assignment", "--convergence"}) {
    runs.push_back(Calibrate({option, absent}));
  }
  for (const ProgramRun& run : runs) {
    EXPECT_EQ(run.exit_code, 2) << run.output;
    EXPECT_THAT(run.output, HasSubstr("absent does not exist; create it first"));
  }
}

/// Nothing is wrong: noise and an actuator's zero are no mistakes.
TEST_F(Mistakes, NoneIsFoundInSoundData) {
  RecordThree({});
  const ProgramRun run = Calibrate();
  EXPECT_EQ(run.exit_code, 0) << run.output;
  EXPECT_THAT(run.output, Not(HasSubstr("Likely reasons")));
}

}  // namespace
}  // namespace palpate::command
