// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/launch/system_supervisor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

namespace palpate::command {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Notes what it is asked to do: "start 0", "signal 0 2".
class NotingHands : public ProcessHands {
 public:
  std::string Start(std::size_t index) override {
    notes.push_back("start " + std::to_string(index));
    return {};
  }
  void Signal(std::size_t index, int signal) override {
    notes.push_back("signal " + std::to_string(index) + " " + std::to_string(signal));
  }
  void Changed(std::size_t, const ProcessSupervisor&) override {}
  void Stopping(const std::string& reason) override { stop_reason = reason; }

  std::vector<std::string> Take() { return std::exchange(notes, {}); }

  std::vector<std::string> notes;
  std::string stop_reason;
};

SupervisedProcess Named(const std::string& name, const std::vector<std::string>& after = {},
                        bool required = false) {
  return {.name = name, .after = after, .required = required, .rules = {}};
}

TEST(SystemSupervisor, StartsEachAfterThoseThatItNames) {
  NotingHands hands;
  SystemSupervisor system({Named("c", {"a", "b"}), Named("a"), Named("b", {"a"})}, &hands);
  system.Step(0.0);
  EXPECT_THAT(hands.Take(), ElementsAre("start 1"));
  system.Step(1.0);
  EXPECT_THAT(hands.Take(), IsEmpty());
  system.Ready(1, 2.0);
  system.Step(2.0);
  EXPECT_THAT(hands.Take(), ElementsAre("start 2"));
  system.Ready(2, 3.0);
  system.Step(3.0);
  EXPECT_THAT(hands.Take(), ElementsAre("start 0"));
  EXPECT_FALSE(system.AllReady());
  system.Ready(0, 4.0);
  EXPECT_TRUE(system.AllReady());
}

TEST(SystemSupervisor, OneThatFinishedWellCountsAsThere) {
  NotingHands hands;
  SystemSupervisor system({Named("a"), Named("b", {"a"})}, &hands);
  system.Step(0.0);
  system.Ended(0, 1.0, {});
  system.Step(1.0);
  EXPECT_THAT(hands.Take(), ElementsAre("start 0", "start 1"));
}

TEST(SystemSupervisor, WhatNamesAFailedOneIsNotStarted) {
  NotingHands hands;
  SystemSupervisor system({Named("a"), Named("b", {"a"}), Named("c", {"b"})}, &hands);
  system.Step(0.0);
  system.Ended(0, 1.0, {.exit_code = 1});
  system.Step(1.0);
  system.Step(1.0);
  EXPECT_TRUE(system.AllEnded());
  EXPECT_THAT(system.process(1).reason(), HasSubstr("because a failed"));
  EXPECT_THAT(system.process(2).reason(), HasSubstr("because b failed"));
  EXPECT_THAT(hands.Take(), ElementsAre("start 0"));
}

TEST(SystemSupervisor, StopsInTheOrderOppositeToTheStart) {
  NotingHands hands;
  SystemSupervisor system({Named("a"), Named("b", {"a"})}, &hands);
  system.Step(0.0);
  system.Ready(0, 0.0);
  system.Step(0.0);
  system.Ready(1, 0.0);
  hands.Take();
  system.RequestStop("enough");
  system.Step(1.0);
  EXPECT_THAT(hands.Take(), ElementsAre("signal 1 2"));
  system.Ended(1, 2.0, {});
  system.Step(2.0);
  EXPECT_THAT(hands.Take(), ElementsAre("signal 0 2"));
  system.Ended(0, 3.0, {});
  EXPECT_TRUE(system.AllEnded());
}

TEST(SystemSupervisor, HurryStopsAllAtOnce) {
  NotingHands hands;
  SystemSupervisor system({Named("a"), Named("b", {"a"})}, &hands);
  system.Step(0.0);
  system.Ready(0, 0.0);
  system.Step(0.0);
  hands.Take();
  system.RequestStop("enough");
  system.Step(1.0);
  system.Hurry(1.1);
  system.Step(1.1);
  EXPECT_THAT(hands.Take(), ElementsAre("signal 1 2", "signal 0 2", "signal 1 15"));
}

TEST(SystemSupervisor, TheEndOfARequiredOneEndsAllAndItsFailureCounts) {
  for (const int exit_code : {0, 1}) {
    NotingHands hands;
    SystemSupervisor system({Named("a"), Named("b", {}, true)}, &hands);
    system.Step(0.0);
    system.Ready(0, 0.0);
    system.Ready(1, 0.0);
    hands.Take();
    system.Ended(1, 1.0, {.exit_code = exit_code});
    system.Step(1.0);
    EXPECT_THAT(hands.Take(), ElementsAre("signal 0 2"));
    EXPECT_THAT(hands.stop_reason, HasSubstr("required process b"));
    system.Ended(0, 2.0, {});
    EXPECT_TRUE(system.AllEnded());
    EXPECT_EQ(system.RequiredFailed(), exit_code != 0);
  }
}

TEST(SystemSupervisor, TheFailureOfAnotherOneEndsNothing) {
  NotingHands hands;
  SystemSupervisor system({Named("a"), Named("b", {}, true)}, &hands);
  system.Step(0.0);
  system.Ready(1, 0.0);
  system.Ended(0, 1.0, {.exit_code = 1});
  system.Step(1.0);
  EXPECT_FALSE(system.IsStopping());
  EXPECT_FALSE(system.RequiredFailed());
}

TEST(SystemSupervisor, AHeldOneWaitsForItsRelease) {
  NotingHands hands;
  SystemSupervisor system({Named("a")}, &hands);
  system.Hold(0);
  system.Step(0.0);
  EXPECT_THAT(hands.Take(), IsEmpty());
  system.Release(0);
  system.Step(1.0);
  EXPECT_THAT(hands.Take(), ElementsAre("start 0"));
}

TEST(SystemSupervisor, TheDeadlineIsTheEarliestOfAll) {
  NotingHands hands;
  SupervisedProcess late = Named("late");
  late.rules.ready_timeout_s = 30.0;
  SupervisedProcess early = Named("early");
  early.rules.ready_timeout_s = 10.0;
  SystemSupervisor system({late, early}, &hands);
  EXPECT_FALSE(system.Deadline_s().has_value());
  system.Step(5.0);
  EXPECT_DOUBLE_EQ(system.Deadline_s().value(), 15.0);
}

}  // namespace
}  // namespace palpate::command
