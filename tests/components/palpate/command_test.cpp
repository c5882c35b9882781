// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/verbs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>

#include "components/palpate/child_process.hpp"
#include "components/palpate/progress_line.hpp"
#include "components/palpate/reference_verb.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "tests/components/palpate/test_robot.hpp"

namespace palpate::command {
namespace {

std::string RefusalOf(const std::vector<std::string>& words) {
  try {
    RunCommand(words);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Command, AnswersHelpAndVersion) {
  EXPECT_EQ(RunCommand({"--help"}), 0);
  EXPECT_EQ(RunCommand({"--version"}), 0);
  for (const char* verb : {"solve", "calibrate", "estimate", "import", "info", "demo"}) {
    EXPECT_EQ(RunCommand({verb, "--help"}), 0) << verb;
  }
}

TEST(Command, RefusesWhatItDoesNotKnowWithDidYouMean) {
  EXPECT_THAT(RefusalOf({"sovle"}), testing::HasSubstr("did you mean 'solve'?"));
  EXPECT_THAT(RefusalOf({"solve", "beam", "--uot", "x"}), testing::HasSubstr("--out"));
  EXPECT_THAT(RefusalOf({}), testing::HasSubstr("a verb is missing"));
  EXPECT_THAT(RefusalOf({"solve", "beam"}), testing::HasSubstr("--out"));
  EXPECT_THAT(
      RefusalOf({"diagnose", "beam", "--data", "D", "--out", "O", "--exclude", "cable_frictoin"}),
      testing::AllOf(testing::HasSubstr("--exclude: unknown cause 'cable_frictoin'"),
                     testing::HasSubstr("did you mean 'cable_friction'?"),
                     testing::HasSubstr("it is one of ")));
}

TEST(Command, ARepeatedOptionLeavesTheRobotToThePositional) {
  const TestFolder folder;
  const std::string out = (folder / "forces.csv").string();
  const std::string calibration = (folder / "c.yaml").string();
  const std::vector<std::vector<std::string>> commands = {
      {"estimate", "--recording", "r1", "no_such", "--data", "D", "--out", out},
      {"estimate", "--contact", "tip: 0, 0, 0.1", "no_such", "--data", "D", "--out", out},
      {"estimate", "--set", "threads=1", "no_such", "--data", "D", "--out", out},
      {"calibrate", "--recording", "r1", "no_such", "--data", "D", "--out", calibration},
      {"calibrate", "--part", "body", "no_such", "--data", "D", "--out", calibration},
      {"calibrate", "--set", "a=1", "no_such", "--data", "D", "--out", calibration},
      {"diagnose", "--set", "perception.voxel_m=1", "no_such", "--data", "D", "--out", "O"},
      {"diagnose", "--exclude", "cable_friction", "no_such", "--data", "D", "--out", "O"},
      {"import", "--rename", "a=b", "no_such.csv", "--out", (folder / "e").string()}};
  for (const std::vector<std::string>& words : commands) {
    const std::string refusal = RefusalOf(words);
    EXPECT_THAT(refusal, testing::Not(testing::HasSubstr("is required"))) << words[1];
    EXPECT_THAT(refusal, testing::Not(testing::IsEmpty())) << words[1];
  }
}

TEST(Command, DescribesRobotMeshAndExperiment) {
  const TestFolder folder;
  const auto robot = WriteBarRobot(folder);
  EXPECT_EQ(RunCommand({"info", robot.string()}), 0);
  EXPECT_EQ(RunCommand({"info", robot.string(), "--json"}), 0);
  EXPECT_EQ(RunCommand({"info", (folder / "bar.vtk").string(), "--unit", "mm"}), 0);
  EXPECT_EQ(RunCommand({"info", PALPATE_SOURCE_DIR "/tests/data/beam_calculix"}), 0);
  EXPECT_THAT(RefusalOf({"info", "nothing.msh"}), testing::HasSubstr("nothing.msh"));
}

TEST(Command, PrintsTheReferenceOfFiles) {
  EXPECT_EQ(RunCommand({"reference", "robot"}), 0);
  EXPECT_EQ(RunCommand({"reference", "camera", "--format", "json-schema"}), 0);
  EXPECT_THAT(Reference({"experiment", "recording"}, false),
              testing::AllOf(testing::HasSubstr("### experiment.yaml"),
                             testing::HasSubstr("### recording.yaml")));
  EXPECT_THAT(RefusalOf({"reference", "robto"}), testing::HasSubstr("did you mean 'robot'?"));
  EXPECT_THAT(RefusalOf({"reference", "robot", "camera", "--format", "json-schema"}),
              testing::HasSubstr("name one kind of file, not 2"));
}

TEST(ProgressLine, SaysRateAndTimeToGo) {
  EXPECT_EQ(ProgressLine::Text("rows", 0, 40, 3.0), "0 of 40 rows");
  EXPECT_EQ(ProgressLine::Text("rows", 10, 40, 5.0), "10 of 40 rows, 2 rows/s, 15 s to go");
}

TEST(ChildProcess, ReportsTheExitCodeAndKeepsTheOutput) {
  const TestFolder folder;
  ChildProcess process("/bin/sh", {"-c", "echo $GREETING; exit 3"}, {{"GREETING", "hello"}},
                       folder / "log");
  EXPECT_EQ(process.Wait(), 3);
  EXPECT_EQ(process.ExitCode(), 3);
  EXPECT_EQ(process.Stop(), 3);
  EXPECT_EQ(ReadFile(folder / "log"), "hello\n");
}

TEST(ChildProcess, EndsWhatStillRuns) {
  const TestFolder folder;
  ChildProcess process("/bin/sleep", {"1000"}, {}, folder / "log");
  EXPECT_FALSE(process.ExitCode());
  EXPECT_EQ(process.Stop(), 128 + SIGINT);
}

TEST(ChildProcess, GivesWayWithAllThatItStarts) {
  const TestFolder folder;
  const std::string ours = std::to_string(getpriority(PRIO_PROCESS, 0));
  ChildProcess process("/bin/sh", {"-c", "until test $(nice) -gt $0; do sleep 0.01; done", ours},
                       {}, folder / "log");
  process.GiveWay();
  EXPECT_EQ(process.Wait(), 0) << ReadFile(folder / "log");
}

TEST(ChildProcess, RefusesAProgramThatIsNotThere) {
  const TestFolder folder;
  EXPECT_THROW(ChildProcess("/no/such/program", {}, {}, folder / "log"), RunError);
  EXPECT_THROW(ChildProcess("/bin/true", {}, {}, "/no/such/folder/log"), RunError);
}

}  // namespace
}  // namespace palpate::command
