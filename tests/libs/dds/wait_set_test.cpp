// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/wait_set.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "tests/libs/dds/test_participant.hpp"

namespace palpate::dds {
namespace {

using std::chrono::milliseconds;

TEST(WaitSet, RunsUntilAnotherThreadStopsIt) {
  TestNode node("node");
  std::thread stopper([&] { node.loop.Stop(); });
  node.loop.Run();
  stopper.join();
  EXPECT_TRUE(node.loop.stopped());
  EXPECT_FALSE(node.WaitFor([] { return true; }));
}

TEST(WaitSet, GivesUpAtTheDeadline) {
  TestNode node("node");
  const auto deadline = WaitSet::Clock::now() + milliseconds(20);
  EXPECT_FALSE(node.loop.DispatchUntil([] { return false; }, deadline));
  EXPECT_GE(WaitSet::Clock::now(), deadline);
}

TEST(WaitSet, CallsATimerOnceInEachPeriod) {
  TestNode node("node");
  int calls = 0;
  const auto start = WaitSet::Clock::now();
  node.loop.Every(milliseconds(5), [&] { ++calls; });
  ASSERT_TRUE(node.WaitFor([&] { return calls == 4; }));
  EXPECT_GE(WaitSet::Clock::now() - start, milliseconds(20));
}

TEST(WaitSet, AnAlarmCallsOnceAtTheTimeSetLast) {
  TestNode node("node");
  int calls = 0;
  Alarm& alarm = node.loop.AddAlarm([&] { ++calls; });
  const auto start = WaitSet::Clock::now();
  alarm.Set(start + std::chrono::hours(1));
  alarm.Set(start + milliseconds(20));
  EXPECT_TRUE(node.WaitFor([&] { return calls > 0; }));
  EXPECT_GE(WaitSet::Clock::now() - start, milliseconds(20));
  EXPECT_FALSE(
      node.loop.DispatchUntil([&] { return calls > 1; }, WaitSet::Clock::now() + milliseconds(20)));
}

TEST(WaitSet, AnAlarmThatWasClearedDoesNotCallAndOneMaySetItselfAnew) {
  TestNode node("node");
  int cleared_calls = 0;
  Alarm& cleared = node.loop.AddAlarm([&] { ++cleared_calls; });
  int calls = 0;
  Alarm* alarm = nullptr;
  alarm = &node.loop.AddAlarm([&] {
    if (++calls < 3) alarm->Set(WaitSet::Clock::now() + milliseconds(1));
  });
  cleared.Set(WaitSet::Clock::now());
  cleared.Clear();
  alarm->Set(WaitSet::Clock::now());
  EXPECT_TRUE(node.WaitFor([&] { return calls == 3; }));
  EXPECT_EQ(cleared_calls, 0);
}

TEST(WaitSet, WakeAsksTheConditionAnew) {
  TestNode node("node");
  std::atomic<bool> ready = false;
  std::thread waker([&] {
    ready = true;
    node.loop.Wake();
  });
  EXPECT_TRUE(node.WaitFor([&] { return ready.load(); }));
  waker.join();
}

}  // namespace
}  // namespace palpate::dds
