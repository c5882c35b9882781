// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/launch/process_supervisor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

namespace palpate::command {
namespace {

using Action = ProcessSupervisor::Action;
using testing::HasSubstr;

constexpr ProcessEnd kCrash{.exit_code = 1, .signal = 0, .peak_memory_bytes = 5000};
constexpr ProcessEnd kWell{.exit_code = 0, .signal = 0, .peak_memory_bytes = 4000};

ProcessSupervisor::Rules WithRespawn(const RespawnPlan& respawn) {
  ProcessSupervisor::Rules rules;
  rules.respawn = respawn;
  return rules;
}

/// Allowed, started and ready at `now_s`.
void RunAt(double now_s, ProcessSupervisor* process) {
  process->Allow(now_s);
  ASSERT_EQ(process->Next(now_s), Action::kStart);
  process->Started(now_s);
  process->Ready(now_s);
}

TEST(ProcessSupervisor, WaitsUntilItIsAllowed) {
  ProcessSupervisor process({});
  EXPECT_EQ(process.Next(100.0), Action::kNone);
  EXPECT_EQ(process.state(), LaunchState::kWaiting);
  EXPECT_FALSE(process.Deadline_s().has_value());
  process.Allow(100.0);
  EXPECT_EQ(process.Next(100.0), Action::kStart);
}

TEST(ProcessSupervisor, IsReadyWhenItSaysSo) {
  ProcessSupervisor process({});
  process.Allow(10.0);
  process.Started(10.0);
  EXPECT_EQ(process.state(), LaunchState::kStarting);
  process.Ready(12.5);
  EXPECT_EQ(process.state(), LaunchState::kReady);
  EXPECT_DOUBLE_EQ(process.ready_after_s(), 2.5);
}

TEST(ProcessSupervisor, OneThatDoesNotNotifyIsReadyWhenStarted) {
  ProcessSupervisor process({.notifies = false, .respawn = {}, .stop = {}});
  process.Allow(10.0);
  process.Started(10.0);
  EXPECT_EQ(process.state(), LaunchState::kReady);
}

TEST(ProcessSupervisor, OneThatIsNotReadyInTimeIsStoppedAndHasFailed) {
  ProcessSupervisor process({.ready_timeout_s = 3.0, .respawn = {}, .stop = {}});
  process.Allow(0.0);
  process.Started(0.0);
  EXPECT_EQ(process.Next(2.9), Action::kNone);
  EXPECT_DOUBLE_EQ(process.Deadline_s().value(), 3.0);
  EXPECT_EQ(process.Next(3.0), Action::kInterrupt);
  process.Ended(3.1, kWell);
  EXPECT_EQ(process.state(), LaunchState::kFailed);
  EXPECT_THAT(process.reason(), HasSubstr("not ready in time"));
}

TEST(ProcessSupervisor, EndedWithZeroIsFinishedAndNotStartedAgain) {
  ProcessSupervisor process(WithRespawn({}));
  RunAt(0.0, &process);
  process.Ended(5.0, kWell);
  EXPECT_EQ(process.state(), LaunchState::kFinished);
  EXPECT_FALSE(process.HasFailed());
  EXPECT_EQ(process.Next(100.0), Action::kNone);
}

TEST(ProcessSupervisor, AlwaysStartsAgainAfterZero) {
  ProcessSupervisor process(WithRespawn({.always = true}));
  RunAt(0.0, &process);
  process.Ended(5.0, kWell);
  EXPECT_EQ(process.state(), LaunchState::kBackingOff);
}

TEST(ProcessSupervisor, WithoutRespawnAFailureIsFinal) {
  ProcessSupervisor process({});
  RunAt(0.0, &process);
  process.Ended(5.0, kCrash);
  EXPECT_EQ(process.state(), LaunchState::kFailed);
  EXPECT_TRUE(process.HasFailed());
}

TEST(ProcessSupervisor, TheWaitDoublesUpToTheLongestAndTheLimitEndsIt) {
  ProcessSupervisor process(
      WithRespawn({.limit = 4, .backoff_s = 1.0, .longest_backoff_s = 3.0, .reset_after_s = 60.0}));
  double now_s = 0.0;
  RunAt(now_s, &process);
  for (const double wait_s : {1.0, 2.0, 3.0, 3.0}) {
    now_s += 1.0;
    process.Ended(now_s, kCrash);
    ASSERT_EQ(process.state(), LaunchState::kBackingOff);
    EXPECT_DOUBLE_EQ(process.Deadline_s().value(), now_s + wait_s);
    EXPECT_EQ(process.Next(now_s + 0.99 * wait_s), Action::kNone);
    now_s += wait_s;
    EXPECT_EQ(process.Next(now_s), Action::kStart);
    process.Started(now_s);
    process.Ready(now_s);
  }
  process.Ended(now_s + 1.0, kCrash);
  EXPECT_EQ(process.state(), LaunchState::kFailed);
  EXPECT_THAT(process.reason(), HasSubstr("after 4 restarts"));
  EXPECT_EQ(process.restarts(), 4);
}

TEST(ProcessSupervisor, ALongRunBeginsTheRowAgain) {
  ProcessSupervisor process(
      WithRespawn({.limit = 1, .backoff_s = 1.0, .longest_backoff_s = 8.0, .reset_after_s = 60.0}));
  RunAt(0.0, &process);
  process.Ended(10.0, kCrash);
  process.Started(11.0);
  process.Ready(12.0);
  process.Ended(71.9, kCrash);  // ready for less than 60 s
  EXPECT_EQ(process.state(), LaunchState::kFailed);

  ProcessSupervisor other(
      WithRespawn({.limit = 1, .backoff_s = 1.0, .longest_backoff_s = 8.0, .reset_after_s = 60.0}));
  RunAt(0.0, &other);
  other.Ended(10.0, kCrash);
  other.Started(11.0);
  other.Ready(12.0);
  other.Ended(72.0, kCrash);
  EXPECT_EQ(other.state(), LaunchState::kBackingOff);
  EXPECT_DOUBLE_EQ(other.Deadline_s().value(), 73.0);
}

TEST(ProcessSupervisor, WrongSettingsOfAComponentAreFinal) {
  ProcessSupervisor::Rules rules = WithRespawn({});
  rules.exit_2_is_final = true;
  ProcessSupervisor process(rules);
  RunAt(0.0, &process);
  process.Ended(0.1, {.exit_code = 2});
  EXPECT_EQ(process.state(), LaunchState::kFailed);
  EXPECT_THAT(process.reason(), HasSubstr("wrong usage or settings"));
}

TEST(ProcessSupervisor, AStartThatFailsCountsAsAFailure) {
  ProcessSupervisor process(WithRespawn({.limit = 1, .backoff_s = 2.0}));
  process.Allow(0.0);
  process.StartFailed(0.0, "cannot start x: no memory");
  EXPECT_DOUBLE_EQ(process.Deadline_s().value(), 2.0);
  process.StartFailed(2.0, "cannot start x: no memory");
  EXPECT_EQ(process.state(), LaunchState::kFailed);
  EXPECT_THAT(process.reason(), HasSubstr("no memory"));
}

TEST(ProcessSupervisor, AStopTakesStrongerSignalsWithTheWaitsOfThePlan) {
  ProcessSupervisor process({.respawn = {}, .stop = {.interrupt_s = 5.0, .terminate_s = 2.0}});
  RunAt(0.0, &process);
  process.Stop(10.0);
  EXPECT_EQ(process.Next(10.0), Action::kInterrupt);
  EXPECT_EQ(process.Next(14.9), Action::kNone);
  EXPECT_EQ(process.Next(15.0), Action::kTerminate);
  EXPECT_EQ(process.Next(16.9), Action::kNone);
  EXPECT_EQ(process.Next(17.0), Action::kKill);
  EXPECT_EQ(process.Next(1000.0), Action::kNone);
  process.Ended(17.1, {.exit_code = 0, .signal = SIGKILL});
  EXPECT_EQ(process.state(), LaunchState::kStopped);
  EXPECT_TRUE(process.HasFailed());
}

TEST(ProcessSupervisor, HurrySendsTheNextSignalAtOnce) {
  ProcessSupervisor process({});
  RunAt(0.0, &process);
  process.Stop(10.0);
  EXPECT_EQ(process.Next(10.0), Action::kInterrupt);
  process.Hurry(10.1);
  EXPECT_EQ(process.Next(10.1), Action::kTerminate);
  process.Hurry(10.2);
  EXPECT_EQ(process.Next(10.2), Action::kKill);
}

TEST(ProcessSupervisor, WhatEndsByTheSignalOfAStopHasNotFailed) {
  for (const ProcessEnd& end :
       {kWell, ProcessEnd{.exit_code = 130}, ProcessEnd{.exit_code = 0, .signal = SIGINT}}) {
    ProcessSupervisor process(WithRespawn({}));
    RunAt(0.0, &process);
    process.Stop(1.0);
    process.Ended(1.1, end);
    EXPECT_EQ(process.state(), LaunchState::kStopped);
    EXPECT_FALSE(process.HasFailed()) << Describe(end);
  }
  ProcessSupervisor process({});
  RunAt(0.0, &process);
  process.Stop(1.0);
  process.Ended(1.1, {.exit_code = 0, .signal = SIGSEGV});
  EXPECT_TRUE(process.HasFailed());
}

TEST(ProcessSupervisor, AStopEndsTheWaitForARestart) {
  ProcessSupervisor process(WithRespawn({}));
  RunAt(0.0, &process);
  process.Ended(1.0, kCrash);
  process.Stop(1.5);
  EXPECT_EQ(process.state(), LaunchState::kStopped);
  EXPECT_EQ(process.Next(100.0), Action::kNone);
}

TEST(ProcessSupervisor, AddsRunTimesAndKeepsTheLargestMemory) {
  ProcessSupervisor process(WithRespawn({}));
  RunAt(0.0, &process);
  process.Ended(2.0, kCrash);
  process.Started(3.0);
  EXPECT_DOUBLE_EQ(process.RunTime_s(4.0), 3.0);
  process.Ready(4.0);
  process.Ended(6.0, kWell);
  EXPECT_DOUBLE_EQ(process.RunTime_s(100.0), 5.0);
  EXPECT_EQ(process.peak_memory_bytes(), 5000);
}

}  // namespace
}  // namespace palpate::command
