// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <sys/resource.h>

#include <csignal>

#include "libs/app/run_main.hpp"
#include "tests/components/palpate/simulate_fixture.hpp"

namespace palpate::command {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

TEST_F(SimulateTest, NeverOverwrites) {
  fs::create_directory(options_.out);
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("exp: "), HasSubstr("exists already")));
  fs::remove(options_.out);
  folder_.Write("exp.answer.json", "mine");
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("exp.answer.json"), HasSubstr("exists already")));
  EXPECT_EQ(AnswerText(), "mine");
  EXPECT_FALSE(fs::exists(options_.out));
}

TEST_F(SimulateTest, RefusesAScenarioOfAnotherRobot) {
  std::string text = kMarkers + kRecordings;
  text.replace(text.find("t_s: 0, top."), 12, "t_s: 0, nort.");
  text.replace(text.find("0.75, top."), 10, "0.75, nort.");
  text.replace(text.find("{t_s: 1, top."), 13, "{t_s: 1, nort.");
  Scenario(text);
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("'b_pull'"), HasSubstr("no actuator 'nort'")));
  Scenario("effects: [{id: cable_gain, where: cable:north, g: 0.1}]\n" + kMarkers + kRecordings);
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("s.yaml:2:11"), HasSubstr("no cable:north")));
  EXPECT_EQ(FilesOf(folder_.path()).size(), 3u);  // robot, mesh, scenario: nothing new
}

TEST_F(SimulateTest, RefusesAScenarioThatMeasuresNothing) {
  Scenario(kRecordings);
  EXPECT_THAT(Refusal(), HasSubstr("s.yaml: measures nothing"));
  const std::string robot = ReadFile(options_.robot);
  const std::size_t markers = robot.find("markers:");
  folder_.Write("bar.yaml", robot.substr(0, markers) + robot.substr(robot.find("feature_points")));
  Scenario(kMarkers + kRecordings);
  EXPECT_THAT(Refusal(), HasSubstr("has no key 'markers'"));
}

TEST_F(SimulateTest, SaysWhichArgumentIsMissing) {
  SimulateOptions none;
  options_ = none;
  EXPECT_THAT(Refusal(), HasSubstr("ROBOT is required"));
  options_.robot = "bar";
  EXPECT_THAT(Refusal(), HasSubstr("--scenario is required"));
  options_.scenario = "s.yaml";
  EXPECT_THAT(Refusal(), HasSubstr("--out is required"));
}

TEST_F(SimulateTest, LeavesNothingWhereASignalEndsIt) {
  log_.raises_after_s = 0.2;
  EXPECT_THAT(Refusal<app::Interrupted>(),
              testing::ContainsRegex("after [0-9]+ of [0-9]+ samples"));
  EXPECT_FALSE(fs::exists(options_.out));
  EXPECT_FALSE(fs::exists(folder_ / "exp.answer.json"));
  for (const auto& entry : fs::directory_iterator(folder_.path())) {
    EXPECT_THAT(entry.path().filename().string(), testing::Not(HasSubstr(".part")));
  }
}

TEST_F(SimulateTest, ChecksItsOutputsBeforeItSimulates) {
  options_.out = folder_.Write("file", "in the way") / "exp";
  EXPECT_THAT(Refusal(), HasSubstr("is not a folder"));
  options_.out = folder_ / "exp";
  options_.answer = folder_ / "no/such/answer.json";
  EXPECT_THAT(Refusal(), HasSubstr("answer.json: cannot be written"));
  EXPECT_TRUE(log_.steps.empty());
}

TEST_F(SimulateTest, LeavesNothingWhereTheBenchFails) {
  log_.fails_after_s = 2.0;
  EXPECT_THAT(Refusal<RunError>(), AllOf(HasSubstr("in 'b_pull' at 2.05 s"), HasSubstr("inverted"),
                                         HasSubstr("inside out")));
  EXPECT_EQ(FilesOf(folder_.path()).size(), 3u);
}

TEST_F(SimulateTest, LeavesNothingWhereTheDiskIsFull) {
  // A limit on the size of files stands in for the disk: markers.csv does not fit.
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  rlimit small = before;
  small.rlim_cur = 300;
  auto* const handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  std::string message;
  try {
    Run();
  } catch (const RunError& error) {
    message = error.what();
  }
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_THAT(message, AllOf(HasSubstr(".csv"), HasSubstr("cannot be written")));
  EXPECT_EQ(FilesOf(folder_.path()).size(), 3u);
}

TEST_F(SimulateTest, LeavesNothingWhereTheAnswerCannotBeWritten) {
  options_.answer = folder_ / "none" / "answer.json";
  EXPECT_THAT(Refusal(), HasSubstr("answer.json"));
  EXPECT_EQ(FilesOf(folder_.path()).size(), 3u);
  options_.answer.clear();
  options_.out = "/proc/none/exp";
  EXPECT_THAT(Refusal<RunError>(), HasSubstr("cannot be created"));
}

}  // namespace
}  // namespace palpate::command
