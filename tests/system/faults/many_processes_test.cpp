// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <signal.h>

#include <chrono>
#include <cstdio>
#include <string>
#include <thread>

#include "libs/core/file.hpp"
#include "libs/core/seconds.hpp"
#include "tests/system/process.hpp"
#include "tests/system/sample_data.hpp"

/// Twenty components at once in one domain of one host: participant indices and ports.
namespace palpate::system_test::many_processes {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;
using testing::Not;

constexpr int kNamespaces = 4;  // of five components each
constexpr seconds kLongestStart{120};

/// Five components for each namespace; none of them has an input.
std::string SystemText(const TestFolder& folder) {
  const std::string robot = std::string(PALPATE_SOURCE_DIR) + "/config/robots/four_leg.yaml";
  std::string text = "name: many\nhosts:\n  - name: here\n    processes:\n";
  const auto add = [&](const std::string& component, int place, const std::string& arguments) {
    const std::string number = std::to_string(place);
    text += "      - {name: " + component + number + ", component: " + component +
            ", remap: [\"__ns:=/place" + number + "\"], required: true, arguments: [" + arguments +
            "]}\n";
  };
  for (int place = 0; place < kNamespaces; ++place) {
    add("capture", place, "--camera, 127.0.0.250");
    add("perception", place, "");
    add("force_estimation", place, robot);
    add("calibration", place, robot);
    add("recorder", place, "--out, " + (folder / (std::to_string(place) + ".mcap")).string());
  }
  return text;
}

bool WaitForText(const Process& process, const std::string& text) {
  const auto end = std::chrono::steady_clock::now() + kLongestStart;
  while (process.Output().find(text) == std::string::npos) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return true;
}

/// Starts all at once, and counts them over the domain.
void ExpectAllToStart() {
  const TestFolder folder;
  WriteFile(folder / "many.yaml", SystemText(folder));
  const auto begin = std::chrono::steady_clock::now();
  Process launch("palpate", {"launch", (folder / "many.yaml").string()}, folder / "launch.log");
  ASSERT_TRUE(WaitForText(launch, "all processes are ready")) << launch.Output();
  std::printf("20 components ready after %.1f s\n", SecondsSince(begin));
  EXPECT_EQ(RunProgram("palpate", {"node", "list", "--count-nodes", "--spin-time", "10"},
                       folder / "count.log"),
            0);
  EXPECT_EQ(ReadFile(folder / "count.log"), std::to_string(5 * kNamespaces) + "\n");
  launch.Signal(SIGINT);
  EXPECT_EQ(launch.Wait(seconds(60)), 0) << launch.Output();
  EXPECT_THAT(launch.Output(), Not(HasSubstr("failed"))) << launch.Output();
}

TEST(ManyProcesses, TwentyStart) { ExpectAllToStart(); }

TEST(ManyProcesses, TwentyStartEveryTime) {
  for (int start = 0; start < 10 && !HasFailure(); ++start) ExpectAllToStart();
}

}  // namespace
}  // namespace palpate::system_test::many_processes
