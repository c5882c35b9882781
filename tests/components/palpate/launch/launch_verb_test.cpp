// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <functional>
#include <nlohmann/json.hpp>
#include <thread>

#include "libs/core/file.hpp"
#include "tests/support/test_folder.hpp"
#include "tests/system/process.hpp"

namespace palpate::command {
namespace {

using system_test::Process;
using test_support::TestFolder;
using testing::HasSubstr;

constexpr auto kLimit = std::chrono::seconds(60);

class LaunchCommand : public testing::Test {
 protected:
  /// A file with one host and these processes, each a line of YAML.
  std::string System(const std::vector<std::string>& processes, const std::string& more = "") {
    std::string text = "name: test\n" + more + "hosts:\n  - name: here\n    processes:\n";
    for (const std::string& process : processes) text += "      - " + process + "\n";
    return folder_.Write("test.yaml", text).string();
  }

  int RunLaunch(std::vector<std::string> words) {
    words.insert(words.begin(), "launch");
    Process launch("palpate", words, folder_ / "log");
    const auto code = launch.Wait(kLimit);
    EXPECT_TRUE(code.has_value()) << "it did not end";
    return code.value_or(-1000);
  }

  std::string Log() const { return ReadFile(folder_ / "log"); }

  static bool WaitFor(const std::function<bool()>& done) {
    const auto deadline = std::chrono::steady_clock::now() + kLimit;
    while (!done()) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return true;
  }

  TestFolder folder_;
};

TEST_F(LaunchCommand, PrefixesLinesAndClosesWithATable) {
  const std::string system =
      System({"{name: greeter, program: sh, arguments: [-c, \"echo hello\"]}",
              "{name: other, program: sh, arguments: [-c, \"exit 5\"]}"});
  EXPECT_EQ(RunLaunch({system}), 0);  // none is required
  EXPECT_THAT(Log(), HasSubstr("[greeter] hello\n"));
  EXPECT_THAT(Log(), HasSubstr("[launch]  other: failed: exit code 5"));
  EXPECT_THAT(Log(), testing::ContainsRegex("greeter +finished +0 +0 +[0-9.]+ s +[0-9.]+ MB\n"));
  EXPECT_THAT(Log(), testing::ContainsRegex("other +failed +5 "));
  EXPECT_THAT(Log(), testing::Not(HasSubstr("\033")));  // no colour in a file
}

TEST_F(LaunchCommand, ARequiredOneThatFailsEndsAllWithOne) {
  const std::string system =
      System({"{name: a, program: sh, arguments: [-c, \"exit 5\"], required: true}",
              "{name: b, program: sleep, arguments: [600]}"});
  EXPECT_EQ(RunLaunch({system}), 1);
  EXPECT_THAT(Log(), HasSubstr("the required process a failed"));
}

TEST_F(LaunchCommand, ARequiredOneThatFinishesEndsAllWithZero) {
  const std::string system =
      System({"{name: a, program: \"true\", required: true}",
              "{name: b, program: sleep, arguments: [600], required: true}"});
  EXPECT_EQ(RunLaunch({system}), 0);
}

TEST_F(LaunchCommand, ASecondSignalHurries) {
  const std::string system = System(
      {"{name: a, program: sh, arguments: [-c, \"trap '' INT TERM; echo armed; while :; do sleep "
       "0.05; done\"], required: true}"},
      "stop: {interrupt_s: 3600, terminate_s: 3600}\n");
  Process launch("palpate", {"launch", system}, folder_ / "log");
  ASSERT_TRUE(WaitFor([&] { return launch.Output().find("armed") != std::string::npos; }));
  launch.Signal(SIGINT);
  ASSERT_TRUE(WaitFor([&] { return launch.Output().find("a signal") != std::string::npos; }));
  launch.Signal(SIGINT);
  ASSERT_TRUE(WaitFor([&] { return launch.Output().find("SIGTERM") != std::string::npos; }));
  launch.Signal(SIGINT);
  EXPECT_EQ(launch.Wait(kLimit), 1);  // a required process had to be killed
  EXPECT_THAT(Log(), HasSubstr("still runs: SIGKILL"));
}

TEST_F(LaunchCommand, JsonIsAllOfTheStandardOutput) {
  const std::string system = System({"{name: a, program: sh, arguments: [-c, \"exit 5\"]}"});
  const std::string out = (folder_ / "out").string();
  const std::string line = std::string(PALPATE_BINARY_DIR "/bin/palpate launch ") + system +
                           " --json > " + out + " 2> " + (folder_ / "err").string();
  EXPECT_EQ(std::system(line.c_str()), 0);
  const auto json = nlohmann::json::parse(ReadFile(out));
  EXPECT_EQ(json["processes"][0]["exit_code"], 5);
  EXPECT_TRUE(json["processes"][0]["signal"].is_null());
  EXPECT_GT(json["processes"][0]["peak_memory_bytes"], 0);
  EXPECT_THAT(ReadFile(folder_ / "err"), HasSubstr("a: failed"));
}

TEST_F(LaunchCommand, ADryRunPrintsWhatWouldBeStarted) {
  EXPECT_EQ(RunLaunch({"demo", "--dry-run", "--set", "perception.min_z_m=0.2", "robot:=rod",
                       "--domain", "77"}),
            0);
  EXPECT_THAT(Log(), HasSubstr("/palpate-perception --set 'camera_pose="));
  EXPECT_THAT(Log(), HasSubstr("--set min_z_m=0.2"));
  EXPECT_THAT(Log(), HasSubstr("/palpate-force-estimation rod "));
  EXPECT_THAT(Log(), HasSubstr("ROS_DOMAIN_ID=77"));
  EXPECT_THAT(Log(), HasSubstr("config/cyclonedds/one_host.xml"));
}

TEST_F(LaunchCommand, GivesAComponentItsSettingsNamesAndDomain) {
  folder_.Write("cam.yaml", "");
  const std::string system =
      System({"{name: cam, component: capture, settings: cam.yaml, arguments: [--camera, x], "
              "remap: [\"/a:=/b\"], set: {queue: 3}}"},
             "domain: 5\nnamespace: /left\n");
  EXPECT_EQ(RunLaunch({system, "--dry-run", "--set", "cam.queue=4"}), 0);
  EXPECT_THAT(Log(),
              HasSubstr("/palpate-capture --camera x --config " + (folder_ / "cam.yaml").string() +
                        " --set queue=3 --set queue=4 --remap __ns:=/left --remap /a:=/b "
                        "--domain 5\n"));
}

TEST_F(LaunchCommand, PassesOnThatFaultsAreAllowed) {
  const std::string process = "{name: cam, component: capture}";
  EXPECT_EQ(RunLaunch({System({process}, "allow_faults: true\n"), "--dry-run"}), 0);
  EXPECT_THAT(Log(), HasSubstr("--set dds.allow_faults=true"));
  EXPECT_EQ(RunLaunch({System({process}), "--dry-run"}), 0);
  EXPECT_THAT(Log(), testing::Not(HasSubstr("allow_faults")));
}

TEST_F(LaunchCommand, RefusesWhatItCannotRead) {
  EXPECT_EQ(RunLaunch({System({"{name: a, component: capture, settings: none.yaml}"})}), 2);
  EXPECT_THAT(Log(), HasSubstr("no settings file"));
  EXPECT_EQ(RunLaunch({"no_such_system"}), 2);
  EXPECT_EQ(RunLaunch({"demo", "robot=rod"}), 2);
  EXPECT_THAT(Log(), HasSubstr("NAME:=VALUE"));
  EXPECT_EQ(RunLaunch({"demo", "--host", "moon"}), 2);
  EXPECT_THAT(Log(), HasSubstr("unknown host 'moon'"));
}

TEST_F(LaunchCommand, RunsComponentsAndStopsThemOnASignal) {
  const std::string system =
      System({"{name: perception, component: perception, required: true}",
              "{name: recorder, component: recorder, arguments: [--out, " +
                  (folder_ / "r.mcap").string() + "], after: [perception], required: true}"});
  Process launch("palpate", {"launch", system}, folder_ / "log");
  ASSERT_TRUE(WaitFor([&] {
    return launch.Output().find("all processes are ready") != std::string::npos;
  })) << launch.Output();
  launch.Signal(SIGINT);
  EXPECT_EQ(launch.Wait(kLimit), 0) << launch.Output();
  EXPECT_THAT(Log(), testing::ContainsRegex("recorder +stopped +0 "));
  EXPECT_THAT(Log(), testing::ContainsRegex("perception +stopped +0 "));
}

TEST_F(LaunchCommand, AComponentWithWrongSettingsIsNotStartedAgain) {
  const std::string system =
      System({"{name: perception, component: perception, set: {no_such: 1}, required: true, "
              "respawn: {}}"});
  EXPECT_EQ(RunLaunch({system}), 1);
  EXPECT_THAT(Log(), HasSubstr("[perception] "));
  EXPECT_THAT(Log(), HasSubstr("wrong usage or settings, not started again"));
}

TEST_F(LaunchCommand, StartsAKilledComponentAgain) {
  const std::string system =
      System({"{name: perception, component: perception, required: true, respawn: {backoff_s: "
              "0.01}}"});
  Process launch("palpate", {"launch", system}, folder_ / "log");
  const auto count = [&](const std::string& text) {
    int found = 0;
    const std::string log = launch.Output();
    for (std::size_t at = 0; (at = log.find(text, at)) != std::string::npos; ++at) ++found;
    return found;
  };
  ASSERT_TRUE(WaitFor([&] { return count("ready after") == 1; }));
  const std::string log = launch.Output();
  const std::string mark = "started (process ";
  const pid_t pid = std::stoi(log.substr(log.find(mark) + mark.size()));
  kill(pid, SIGKILL);
  EXPECT_TRUE(WaitFor([&] { return count("ready after") == 2; })) << launch.Output();
  launch.Signal(SIGTERM);
  EXPECT_EQ(launch.Wait(kLimit), 0);
  EXPECT_THAT(Log(), HasSubstr("signal 9 (Killed)"));
  EXPECT_THAT(Log(), testing::ContainsRegex("perception +stopped +0 +1 "));
}

}  // namespace
}  // namespace palpate::command
