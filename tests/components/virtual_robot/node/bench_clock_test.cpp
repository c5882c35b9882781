// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "components/virtual_robot/node/bench_clock.hpp"

namespace palpate::virtual_robot {
namespace {

TEST(BenchClock, TicksOncePerPeriodOnOneGrid) {
  BenchClock clock(0.1, 0.5);
  clock.Start(20.0);
  for (int tick = 1; tick <= 5; ++tick) {
    EXPECT_NEAR(clock.Due_s(), 20.0 + 0.1 * tick, 1e-12);
    // A little late each time: the grid does not move.
    EXPECT_NEAR(clock.Tick(clock.Due_s() + 0.03), 0.1 * tick, 1e-12);
  }
  EXPECT_EQ(clock.missed(), 0u);
}

TEST(BenchClock, CatchesUpWithOneLongStepAfterAPause) {
  BenchClock clock(0.1, 0.5);
  clock.Start(0.0);
  clock.Tick(0.1);
  EXPECT_NEAR(clock.Tick(0.45), 0.4, 1e-12);  // due at 0.2; 0.3 and 0.4 went by
  EXPECT_EQ(clock.missed(), 2u);
  EXPECT_NEAR(clock.Due_s(), 0.5, 1e-12);
}

TEST(BenchClock, ALongPauseIsLostBeyondTheLargestStep) {
  BenchClock clock(0.1, 0.3);
  clock.Start(0.0);
  EXPECT_NEAR(clock.Tick(5.05), 0.3, 1e-12);
  EXPECT_EQ(clock.missed(), 49u);
  EXPECT_NEAR(clock.Due_s(), 5.1, 1e-9);
  EXPECT_NEAR(clock.Tick(5.1 + 1e-9), 0.4, 1e-9);
}

TEST(BenchClock, ALargestStepBelowThePeriodIsThePeriod) {
  BenchClock clock(0.1, 0.001);
  clock.Start(0.0);
  EXPECT_NEAR(clock.Tick(1.0), 0.1, 1e-12);
}

}  // namespace
}  // namespace palpate::virtual_robot
