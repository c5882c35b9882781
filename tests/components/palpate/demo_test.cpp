// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <regex>
#include <string>
#include <thread>

#include "libs/app/child_process.hpp"
#include "libs/core/file.hpp"
#include "tests/components/palpate/test_robot.hpp"

namespace palpate::command {
namespace {

int RunDemo(const TestFolder& folder, const std::vector<std::string>& more) {
  std::vector<std::string> words = {"demo", "--out", (folder / "demo").string()};
  words.insert(words.end(), more.begin(), more.end());
  app::ChildProcess demo(PALPATE_BINARY_DIR "/bin/palpate", words, {}, folder / "log");
  return demo.Wait();
}

TEST(Demo, FindsTheWeightThroughTheProcessesAndDrawsIt) {
  const TestFolder folder;
  EXPECT_EQ(RunDemo(folder, {"--computed"}), 0);
  const std::string text = ReadFile(folder / "log");
  EXPECT_THAT(text, testing::HasSubstr("60 marker frames estimated"));
  EXPECT_THAT(text, testing::HasSubstr("truth      0.510 N"));
  EXPECT_THAT(text, testing::HasSubstr("inside the interval"));
  EXPECT_GT(std::filesystem::file_size(folder / "demo/scene.png"), 20000U);
  EXPECT_THAT(ReadFile(folder / "demo/forces.svg"), testing::HasSubstr("<polyline"));
  EXPECT_GT(std::filesystem::file_size(folder / "demo/recording.mcap"), 20000U);
  EXPECT_THAT(text, testing::HasSubstr("in a browser: http://127.0.0.1:"));
  EXPECT_THAT(text, testing::HasSubstr("palpate view "));
}

TEST(Demo, RefusesADataFolderWithoutTheBeam) {
  const TestFolder folder;
  EXPECT_EQ(RunDemo(folder, {"--recording", "beam", "--data", folder.path().string()}), 2);
  EXPECT_THAT(ReadFile(folder / "log"), testing::HasSubstr("no silicone_beam/"));
}

TEST(Demo, RefusesRecordingsWithoutARobotOrWithoutImages) {
  const TestFolder folder;
  EXPECT_EQ(RunDemo(folder, {"--data", folder.path().string()}), 2);
  EXPECT_THAT(ReadFile(folder / "log"), testing::HasSubstr("--data needs --robot"));
  EXPECT_EQ(RunDemo(folder,
                    {"--robot", "beam", "--data", PALPATE_SOURCE_DIR "/tests/data/beam_calculix"}),
            2);
  EXPECT_THAT(ReadFile(folder / "log"), testing::HasSubstr("no recording has depth images"));
  EXPECT_EQ(RunDemo(folder, {"--computed", "--robot", "four_leg"}), 2);
}

TEST(Demo, AScenarioWithoutACameraIsRefusedBeforeAnythingStarts) {
  const TestFolder folder;
  const auto scenario =
      folder.Write("s.yaml", "name: s\nrecordings: [{name: a, kind: rest, duration_s: 1}]\n");
  EXPECT_EQ(RunDemo(folder, {"--scenario", scenario.string()}), 2);
  EXPECT_THAT(ReadFile(folder / "log"), testing::HasSubstr("has no camera"));
  EXPECT_FALSE(std::filesystem::exists(folder / "demo/capture.log"));
}

/// Mean error and frames of a line of the result, "  one, in view  4.2 % mean error over 17
/// frames".
struct DemoScore {
  double error_percent = -1.0;
  int frames = 0;
};
DemoScore ScoreIn(const std::string& text, const std::string& line) {
  const std::regex pattern(line + R"( +([\d.]+) % mean error over (\d+) frames)");
  std::smatch found;
  if (!std::regex_search(text, found, pattern)) return {};
  return {std::stod(found[1]), std::stoi(found[2])};
}

/// A robot of one chamber and a body finer than four_leg's, through all processes.
TEST(PneumaticDemo, FindsForcesOnTheFingerAtRestAndUnderPressure) {
  const TestFolder folder;
  EXPECT_EQ(RunDemo(folder, {"--robot", "pneumatic_finger", "--no-view"}), 0);
  const std::string text = ReadFile(folder / "log");
  const DemoScore seen = ScoreIn(text, "one, in view");
  EXPECT_GE(seen.frames, 5) << text;
  EXPECT_LT(seen.error_percent, 30.0) << text;
  EXPECT_THAT(ReadFile(folder / "demo/scenario.yaml"), testing::HasSubstr("bend.pressure_Pa"));
  EXPECT_THAT(ReadFile(folder / "demo/forces.svg"), testing::HasSubstr("<polyline"));
  EXPECT_GT(std::filesystem::file_size(folder / "demo/recording.mcap"), 20000U);
}

// Of the programs of this domain, those that run.
std::vector<std::string> ProgramsOfDomain(const std::string& domain) {
  std::vector<std::string> programs;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    std::ifstream stream(entry.path() / "cmdline");
    std::vector<std::string> words;
    for (std::string word; std::getline(stream, word, '\0');) words.push_back(word);
    const auto option = std::find(words.begin(), words.end(), "--domain");
    if (option != words.end() && option + 1 != words.end() && *(option + 1) == domain) {
      programs.push_back(words.front());
    }
  }
  return programs;
}

TEST(Demo, AnInterruptEndsAllProcesses) {
  const TestFolder folder;
  app::ChildProcess demo(PALPATE_BINARY_DIR "/bin/palpate",
                         {"demo", "--out", (folder / "demo").string(), "--seconds", "600"}, {},
                         folder / "log");
  // The domain, once it is printed; then until those of the sensing side run, or more: they start
  // faster than a busy machine lets this test count them.
  std::string domain;
  const auto all_run = [&] {
    const std::string text = ReadFile(folder / "log");
    const std::size_t at = text.find("DDS domain ");
    if (at == std::string::npos || text.find(',', at) == std::string::npos) return false;
    domain = std::to_string(std::stoi(text.substr(at + std::string("DDS domain ").size())));
    return ProgramsOfDomain(domain).size() >= 4;
  };
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!all_run() && !demo.ExitCode() && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::yield();
  }
  ASSERT_THAT(ProgramsOfDomain(domain), testing::Not(testing::IsEmpty()));
  const int code = demo.Stop();
  EXPECT_THAT(ProgramsOfDomain(domain), testing::SizeIs(0));
  // A busy machine may see a force before it is interrupted.
  const std::string text = ReadFile(folder / "log");
  const bool found_a_force = text.find("[3/3] Result") != std::string::npos &&
                             text.find("no message arrived") == std::string::npos &&
                             text.find("failed: no ") == std::string::npos;
  EXPECT_EQ(code, found_a_force ? 0 : 1) << text;
  EXPECT_THAT(text, testing::HasSubstr("[3/3] Result"));
}

}  // namespace
}  // namespace palpate::command
