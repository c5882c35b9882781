// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/launch/launcher.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <functional>
#include <thread>

#include "libs/core/file.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::command {
namespace {

using test_support::TestFolder;
using testing::Contains;
using testing::HasSubstr;

constexpr auto kLauncherLimit = std::chrono::seconds(30);

class NotingOutput : public LaunchOutput {
 public:
  void Line(const std::string& process, std::string_view line) override {
    lines.push_back(process + ": " + std::string(line));
  }
  void Event(const std::string& process, Severity, const std::string& text) override {
    events.push_back(process + ": " + text);
  }

  std::vector<std::string> lines;
  std::vector<std::string> events;
};

LaunchedProcess Shell(const std::string& name, const std::string& script, bool notifies = false) {
  LaunchedProcess one;
  one.process.name = name;
  one.process.rules.notifies = notifies;
  one.command.program = "/bin/sh";
  one.command.arguments = {"-c", script};
  return one;
}

/// Turns until `done`; false where that takes too long.
bool TurnUntil(Launcher* launcher, const std::function<bool()>& done) {
  const auto deadline = std::chrono::steady_clock::now() + kLauncherLimit;
  while (!done()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    launcher->Turn(0.05);
  }
  return true;
}

bool RunToTheEnd(Launcher* launcher) {
  bool ended = false;
  return TurnUntil(launcher, [&] {
    ended = !launcher->Turn(0.05);
    return ended;
  });
}

bool Runs(pid_t pid) {
  std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(stat, text);
  const std::size_t end = text.rfind(')');
  return end != std::string::npos && text.size() > end + 2 && text[end + 2] != 'Z';
}

bool WaitUntil(const std::function<bool()>& done) {
  const auto deadline = std::chrono::steady_clock::now() + kLauncherLimit;
  while (!done()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

/// The process numbers that scripts wrote, one a line; all `count` of them.
std::vector<pid_t> ReadPids(const std::filesystem::path& file, std::size_t count) {
  std::vector<pid_t> pids;
  WaitUntil([&] {
    pids.clear();
    std::ifstream stream(file);
    for (pid_t pid = 0; stream >> pid;) pids.push_back(pid);
    return pids.size() == count;
  });
  return pids;
}

TEST(Launcher, PassesLinesOfBothOutputsAndTheEnd) {
  NotingOutput output;
  Launcher launcher({Shell("a", "echo one; echo two >&2; printf three; exit 4")}, {}, &output);
  ASSERT_TRUE(RunToTheEnd(&launcher));
  EXPECT_THAT(output.lines, testing::ElementsAre("a: one", "a: two", "a: three"));
  const ProcessReport report = launcher.Reports().at(0);
  EXPECT_EQ(report.last_end->exit_code, 4);
  EXPECT_TRUE(report.failed);
  EXPECT_GT(report.peak_memory_bytes, 0);
  EXPECT_GT(report.run_time_s, 0.0);
}

TEST(Launcher, PassesALongOutputWhole) {
  NotingOutput output;
  Launcher launcher({Shell("a", "seq 1 50000")}, {}, &output);
  ASSERT_TRUE(RunToTheEnd(&launcher));
  ASSERT_EQ(output.lines.size(), 50000U);
  EXPECT_EQ(output.lines.back(), "a: 50000");
}

TEST(Launcher, StartsAgainUntilTheLimit) {
  NotingOutput output;
  LaunchedProcess one = Shell("a", "echo again; exit 3");
  one.process.rules.respawn = RespawnPlan{.limit = 2, .backoff_s = 0.01};
  one.process.required = true;
  Launcher launcher({one}, {}, &output);
  ASSERT_TRUE(RunToTheEnd(&launcher));
  EXPECT_EQ(output.lines.size(), 3U);
  EXPECT_EQ(launcher.Reports().at(0).restarts, 2);
  EXPECT_TRUE(launcher.RequiredFailed());
}

TEST(Launcher, TellsTheSignalThatEndedAProcess) {
  NotingOutput output;
  Launcher launcher({Shell("a", "kill -SEGV $$")}, {}, &output);
  ASSERT_TRUE(RunToTheEnd(&launcher));
  EXPECT_EQ(launcher.Reports().at(0).last_end->signal, SIGSEGV);
  EXPECT_THAT(output.events, Contains(HasSubstr("signal 11")));
}

TEST(Launcher, AProgramThatCannotBeExecutedHasFailed) {
  NotingOutput output;
  LaunchedProcess one = Shell("a", "");
  one.command.program = "/no/such/program";
  Launcher launcher({one}, {}, &output);
  ASSERT_TRUE(RunToTheEnd(&launcher));
  EXPECT_THAT(output.events, Contains(HasSubstr("No such file")));
}

TEST(Launcher, GivesNeitherInputNorSignalsOfOursToAProcess) {
  NotingOutput output;
  // Ignored signals would be inherited.
  const auto before = std::signal(SIGINT, SIG_IGN);
  Launcher launcher({Shell("a", "cat; echo end of input; kill -INT $$; echo ignored")}, {},
                    &output);
  ASSERT_TRUE(RunToTheEnd(&launcher));
  std::signal(SIGINT, before);
  EXPECT_THAT(output.lines, testing::ElementsAre("a: end of input"));
}

TEST(Launcher, AddsToTheEnvironmentAndTheNiceness) {
  NotingOutput output;
  LaunchedProcess one = Shell("a", "echo $FRUIT $(nice)");
  one.command.environment["FRUIT"] = "pear";
  one.command.nice = 3;
  Launcher launcher({one}, {}, &output);
  ASSERT_TRUE(RunToTheEnd(&launcher));
  const int niceness = nice(0) + 3;
  EXPECT_EQ(output.lines.at(0), "a: pear " + std::to_string(std::min(niceness, 19)));
}

TEST(Launcher, TheNextStartsWhenTheFirstSaysThatItIsReady) {
  if (access("/usr/bin/python3", X_OK) != 0) GTEST_SKIP() << "python3 is not installed";
  const TestFolder folder;
  const std::string go = (folder / "go").string();
  NotingOutput output;
  LaunchedProcess first = Shell("first", "", true);
  first.command.program = "/usr/bin/python3";
  first.command.arguments = {
      "-c",
      "import os, socket, time\n"
      "while not os.path.exists('" +
          go +
          "'): time.sleep(0.01)\n"
          "s = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)\n"
          "s.sendto(b'STATUS=x\\nREADY=1', '\\0' + os.environ['NOTIFY_SOCKET'][1:])\n"
          "time.sleep(60)\n"};
  LaunchedProcess second = Shell("second", "echo here; sleep 60");
  second.process.after = {"first"};
  Launcher launcher({first, second}, {}, &output);
  for (int turn = 0; turn < 10; ++turn) launcher.Turn(0.02);
  EXPECT_THAT(output.events, testing::Not(Contains(HasSubstr("second: started"))));
  folder.Write("go", "");
  EXPECT_TRUE(TurnUntil(&launcher, [&] { return launcher.AllReady(); }));
  launcher.StopAll("end of the test");
  EXPECT_THAT(output.events, Contains(HasSubstr("first: ready after")));
  EXPECT_FALSE(launcher.RequiredFailed());
}

TEST(Launcher, KillsWhatTakesNeitherSIGINTNorSIGTERM) {
  NotingOutput output;
  Launcher launcher({Shell("a", "trap '' INT TERM; echo armed; while :; do sleep 0.05; done")},
                    {.interrupt_s = 0.1, .terminate_s = 0.1}, &output);
  ASSERT_TRUE(TurnUntil(&launcher, [&] { return !output.lines.empty(); }));
  launcher.StopAll("end of the test");
  EXPECT_EQ(launcher.Reports().at(0).last_end->signal, SIGKILL);
  EXPECT_THAT(output.events, Contains(HasSubstr("still runs: SIGTERM")));
  EXPECT_THAT(output.events, Contains(HasSubstr("still runs: SIGKILL")));
}

TEST(Launcher, HurryNeedsNoWaits) {
  NotingOutput output;
  Launcher launcher({Shell("a", "trap '' INT TERM; echo armed; while :; do sleep 0.05; done")},
                    {.interrupt_s = 3600.0, .terminate_s = 3600.0}, &output);
  ASSERT_TRUE(TurnUntil(&launcher, [&] { return !output.lines.empty(); }));
  launcher.RequestStop("first Ctrl-C");
  launcher.Turn(0.05);
  launcher.Hurry();
  launcher.Hurry();
  EXPECT_TRUE(RunToTheEnd(&launcher));
  EXPECT_EQ(launcher.Reports().at(0).last_end->signal, SIGKILL);
}

TEST(Launcher, EndsTheChildrenOfAProcessWithIt) {
  const TestFolder folder;
  NotingOutput output;
  const std::string pids = (folder / "pids").string();
  Launcher launcher({Shell("a", "sleep 600 & echo $! > " + pids + "; exit 0")}, {}, &output);
  ASSERT_TRUE(RunToTheEnd(&launcher));
  const std::vector<pid_t> left = ReadPids(pids, 1);
  ASSERT_EQ(left.size(), 1U);
  EXPECT_TRUE(WaitUntil([&] { return !Runs(left[0]); }));
}

// The launcher itself is killed: in another process, so that it can be.
TEST(Launcher, NothingIsLeftWhenTheLauncherIsKilled) {
  const TestFolder folder;
  const std::string pids = (folder / "pids").string();
  const std::string stubborn = "trap '' INT TERM; sleep 600 & echo $! >> " + pids +
                               "; echo $$ >> " + pids + "; while :; do sleep 0.05; done";
  const pid_t launcher_pid = fork();
  if (launcher_pid == 0) {
    NotingOutput output;
    Launcher launcher({Shell("a", stubborn), Shell("b", "echo $$ >> " + pids + "; sleep 600")},
                      {.interrupt_s = 0.2, .terminate_s = 0.2}, &output);
    while (launcher.Turn(0.05)) {
    }
    _exit(0);
  }
  const std::vector<pid_t> left = ReadPids(pids, 3);
  EXPECT_EQ(left.size(), 3U);
  kill(launcher_pid, SIGKILL);
  waitpid(launcher_pid, nullptr, 0);
  for (const pid_t pid : left) EXPECT_TRUE(WaitUntil([&] { return !Runs(pid); })) << pid;
}

}  // namespace
}  // namespace palpate::command
