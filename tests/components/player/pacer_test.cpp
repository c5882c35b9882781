// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/player/pacer.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace palpate::player {
namespace {

using std::chrono::milliseconds;

/// A clock that stands until it is set.
struct HandClock {
  milliseconds now{1000};
  Pacer::Clock AsFunction() {
    return [this] { return now; };
  }
};

TEST(Pacer, EventsKeepTheirDistancesDividedByTheRate) {
  HandClock clock;
  Pacer pacer(2.0, clock.AsFunction());
  EXPECT_EQ(pacer.TimeUntil("a", 10.0), milliseconds(0));
  EXPECT_EQ(pacer.TimeUntil("a", 10.5), milliseconds(250));
  clock.now += milliseconds(100);
  EXPECT_EQ(pacer.TimeUntil("a", 10.5), milliseconds(150));
}

TEST(Pacer, ALateEventIsDueAtOnceAndDelaysNoLaterOne) {
  HandClock clock;
  Pacer pacer(1.0, clock.AsFunction());
  EXPECT_EQ(pacer.TimeUntil("a", 0.0), milliseconds(0));
  clock.now += milliseconds(300);
  EXPECT_EQ(pacer.TimeUntil("a", 0.2), milliseconds(0));
  EXPECT_EQ(pacer.TimeUntil("a", 0.4), milliseconds(100));
}

TEST(Pacer, ANewRecordingOrATurnBackInTimeBeginsAtOnce) {
  HandClock clock;
  Pacer pacer(1.0, clock.AsFunction());
  pacer.TimeUntil("a", 0.0);
  EXPECT_EQ(pacer.TimeUntil("b", 5.0), milliseconds(0));
  EXPECT_EQ(pacer.TimeUntil("b", 6.0), milliseconds(1000));
  EXPECT_EQ(pacer.TimeUntil("b", 5.5), milliseconds(0));
  pacer.Restart();
  EXPECT_EQ(pacer.TimeUntil("b", 9.0), milliseconds(0));
}

TEST(Pacer, AtInfiniteRateNothingWaits) {
  HandClock clock;
  Pacer pacer(std::numeric_limits<double>::infinity(), clock.AsFunction());
  EXPECT_EQ(pacer.TimeUntil("a", 0.0), milliseconds(0));
  EXPECT_EQ(pacer.TimeUntil("a", 1e6), milliseconds(0));
}

}  // namespace
}  // namespace palpate::player
