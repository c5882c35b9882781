// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/verbs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <regex>
#include <sstream>
#include <thread>

#include "components/palpate/diagnose_verb.hpp"
#include "components/palpate/end_on_signal.hpp"
#include "components/palpate/find_robot.hpp"
#include "components/palpate/info_verb.hpp"
#include "components/palpate/progress_line.hpp"
#include "components/palpate/reference_verb.hpp"
#include "components/palpate/robot_scene.hpp"
#include "libs/app/child_process.hpp"
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

TEST(ProgressLine, CountsTheShareOfWhatIsBeingDone) {
  EXPECT_EQ(ProgressLine::Text("rows", 2, 4, 5.0, 0.5), "2 of 4 rows, 0.5 rows/s, 3 s to go");
  EXPECT_EQ(ProgressLine::Text("rows", 0, 4, 5.0, 0.0), "0 of 4 rows");
}

TEST(ProgressLine, SaysWhatIsBeingDoneAndAdvisesOnceWhereMuchIsToGo) {
  std::int64_t now_ns = 0;
  testing::internal::CaptureStderr();
  {
    ProgressLine progress("rows", 100, [&] { return now_ns; });
    progress.SetAdvice("try less");
    now_ns = 4'000'000'000;
    progress.Update(1);
    now_ns = 12'000'000'000;
    progress.Update(3, 0.5, [] { return std::string("row 3: 50 %"); });
    now_ns = 30'000'000'000;
    progress.Update(4);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "try less\n"
            "3 of 100 rows, 0.292 rows/s, 331 s to go; row 3: 50 %\n"
            "4 of 100 rows, 0.133 rows/s, 720 s to go\n");
}

TEST(ProgressLine, AdvisesNothingWhereLittleIsToGo) {
  std::int64_t now_ns = 0;
  testing::internal::CaptureStderr();
  {
    ProgressLine progress("rows", 100, [&] { return now_ns; });
    progress.SetAdvice("try less");
    now_ns = 6'000'000'000;
    progress.Update(90);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

/// Options of a verb with the text of each, from its --help.
std::map<std::string, std::string> OptionsOf(const std::string& verb) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(RunCommand({verb, "--help"}), 0);
  std::istringstream lines(testing::internal::GetCapturedStdout());
  std::map<std::string, std::string> options;
  std::string option;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("  --")) option = line.substr(2, line.find("  ", 2) - 2);
    if (!option.empty()) options[option] += " " + line;
  }
  return options;
}

TEST(Command, SaysOfEachOptionWithAValueWhatHoldsWithoutIt) {
  for (const char* verb : {"solve", "simulate", "calibrate", "estimate", "import", "capture",
                           "diagnose", "info", "reference", "demo"}) {
    for (const auto& [option, text] : OptionsOf(verb)) {
      if (option.find(' ') == std::string::npos) continue;  // a flag
      const std::string words = std::regex_replace(text, std::regex(" +"), " ");
      EXPECT_THAT(words, testing::ContainsRegex("default: |required|without it|may be repeated"))
          << verb << " " << option;
    }
  }
}

TEST(StepLine, CountsFromOneAndClaimsNoTimeToGo) {
  EXPECT_EQ(StepLine(0, 7, "simulating", 3.4, 600.0),
            "step 1 of at most 7: simulating (3 s so far; the search ends after 600 s)");
  EXPECT_EQ(StepLine(1, 7, "fitting", 12.0, 0.0), "step 2 of at most 7: fitting (12 s so far)");
  EXPECT_EQ(StepLine(1, 7, "fitting", 60.4, 60.0),
            "step 2 of at most 7: fitting (60 s so far; the 60 s are over, only what a verdict "
            "needs is done)");
}

TEST(Command, SaysThatAMeshIsTooLargeForItsUnit) {
  const TestFolder folder;
  WriteBarRobot(folder);
  const std::string mesh = (folder / "bar.vtk").string();
  const auto output = [](const std::vector<std::string>& words) {
    testing::internal::CaptureStdout();
    EXPECT_EQ(RunCommand(words), 0);
    return testing::internal::GetCapturedStdout();
  };
  EXPECT_THAT(output({"info", mesh, "--unit", "m"}),
              testing::HasSubstr("warning: 80 m long: --unit mm?"));
  EXPECT_THAT(output({"info", mesh}),
              testing::AllOf(testing::HasSubstr("does not say its unit of length"),
                             testing::HasSubstr("--unit mm means 80 x"),
                             testing::Not(testing::HasSubstr("m3"))));
  EXPECT_THAT(output({"info", mesh, "--unit", "mm"}), testing::Not(testing::HasSubstr("warning")));
}

/// The process is asked to end once `file` is there.
int InterruptOnce(app::ChildProcess* process, const std::filesystem::path& file) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!std::filesystem::exists(file) && !process->ExitCode() &&
         std::chrono::steady_clock::now() < end) {
    std::this_thread::yield();
  }
  return process->Stop();
}

TEST(InfoPicture, ShowsWhereContactsAreSearched) {
  const TestFolder folder;
  const auto model = LoadRobot(WriteBarRobot(folder));
  const view::Scene scene = MakeUndeformedScene(*model);
  ASSERT_EQ(scene.points.size(), 2U);
  EXPECT_EQ(scene.points[0].name, "contact candidates");
  EXPECT_EQ(scene.points[0].points_m.cols(), 3);
  EXPECT_EQ(scene.points[1].points_m.cols(), 1);
  EXPECT_EQ(scene.tubes.size(), 1U);
  InfoOptions options;
  options.target = folder / "bar.yaml";
  options.png = folder / "bar.png";
  EXPECT_EQ(Info(options), 0);
  EXPECT_THAT(ReadFile(options.png), testing::StartsWith("\x89PNG"));
  options.target = folder / "bar.vtk";
  EXPECT_THROW(Info(options), InputError);
}

TEST(Interrupted, SolveLeavesTheRowsThatItHas) {
  const TestFolder folder;
  std::string rows = "t_s\n";
  for (int i = 0; i < 100000; ++i) rows += std::to_string(i) + "\n";
  const std::string out = (folder / "out").string();
  app::ChildProcess process(PALPATE_BINARY_DIR "/bin/palpate",
                            {"solve", WriteBarRobot(folder).string(), "--actuation",
                             folder.Write("a.csv", rows).string(), "--out", out},
                            {}, folder / "log");
  EXPECT_EQ(InterruptOnce(&process, folder / "out/nodes_0002.csv"), 130);
  EXPECT_THAT(ReadFile(folder / "log"),
              testing::ContainsRegex(
                  "palpate: interrupted after [0-9]+ of 100000 rows: they are in .*out"));
  EXPECT_THAT(ReadFile(folder / "out/result.json"), testing::HasSubstr("\"interrupted\": true"));
  EXPECT_TRUE(std::filesystem::exists(folder / "out/markers.csv"));
}

TEST(Interrupted, CalibrateSaysThatNothingWasWritten) {
  const TestFolder folder;
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(
      {
        const EndOnSignal end("palpate calibrate", "no calibration was written");
        raise(SIGTERM);
        for (;;) std::this_thread::yield();
      },
      testing::ExitedWithCode(130), "palpate calibrate: interrupted: no calibration was written");
}

TEST(Interrupted, ATemporaryFolderIsRemoved) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  // The child runs the test from its begin; both shall know the folder.
  const pid_t test = testing::internal::InDeathTestChild() ? getppid() : getpid();
  const auto folder = std::filesystem::path(testing::TempDir()) /
                      ("palpate_removed_on_signal_" + std::to_string(test));
  std::filesystem::create_directories(folder / "depth");
  EXPECT_EXIT(
      {
        const EndOnSignal end("palpate calibrate", "no calibration was written");
        RemoveOnSignal(folder);
        raise(SIGTERM);
        // What fails for want of the folder does not end the process.
        while (std::filesystem::exists(folder)) std::this_thread::yield();
        RemoveOnSignal({});
        std::_Exit(1);
      },
      testing::ExitedWithCode(130), "palpate calibrate: interrupted: no calibration was written");
  EXPECT_FALSE(std::filesystem::exists(folder));
}

TEST(ChildProcess, ReportsTheExitCodeAndKeepsTheOutput) {
  const TestFolder folder;
  app::ChildProcess process("/bin/sh", {"-c", "echo $GREETING; exit 3"}, {{"GREETING", "hello"}},
                            folder / "log");
  EXPECT_EQ(process.Wait(), 3);
  EXPECT_EQ(process.ExitCode(), 3);
  EXPECT_EQ(process.Stop(), 3);
  EXPECT_EQ(ReadFile(folder / "log"), "hello\n");
}

TEST(ChildProcess, EndsWhatStillRuns) {
  const TestFolder folder;
  app::ChildProcess process("/bin/sleep", {"1000"}, {}, folder / "log");
  EXPECT_FALSE(process.ExitCode());
  EXPECT_EQ(process.Stop(), 128 + SIGINT);
}

TEST(ChildProcess, GivesWayWithAllThatItStarts) {
  const TestFolder folder;
  const std::string ours = std::to_string(getpriority(PRIO_PROCESS, 0));
  app::ChildProcess process("/bin/sh",
                            {"-c", "until test $(nice) -gt $0; do sleep 0.01; done", ours}, {},
                            folder / "log");
  process.GiveWay();
  EXPECT_EQ(process.Wait(), 0) << ReadFile(folder / "log");
}

TEST(ChildProcess, RefusesAProgramThatIsNotThere) {
  const TestFolder folder;
  EXPECT_THROW(app::ChildProcess("/no/such/program", {}, {}, folder / "log"), RunError);
  EXPECT_THROW(app::ChildProcess("/bin/true", {}, {}, "/no/such/folder/log"), RunError);
}

}  // namespace
}  // namespace palpate::command
