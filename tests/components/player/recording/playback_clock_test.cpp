// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/player/playback_clock.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace palpate::player {
namespace {

/// A clock that stands until it is set.
class PlaybackClockTest : public testing::Test {
 protected:
  Clock Real() {
    return [this] { return now_ns_; };
  }
  std::int64_t now_ns_ = 5000;
};

TEST_F(PlaybackClockTest, TimeRunsAtTheRate) {
  PlaybackClock clock(2.0, Real());
  clock.Set(100);
  now_ns_ += 10;
  EXPECT_EQ(clock.Now_ns(), 120);
  EXPECT_EQ(clock.Until_ns(200), 40);
  EXPECT_EQ(clock.Until_ns(110), 0);
}

TEST_F(PlaybackClockTest, TimeStandsWhilePaused) {
  PlaybackClock clock(1.0, Real());
  clock.Set(100);
  now_ns_ += 10;
  clock.Pause();
  now_ns_ += 1000;
  EXPECT_EQ(clock.Now_ns(), 110);
  EXPECT_EQ(clock.Until_ns(120), std::nullopt);
  clock.Resume();
  now_ns_ += 5;
  EXPECT_EQ(clock.Now_ns(), 115);
}

TEST_F(PlaybackClockTest, AChangeOfTheRateMovesNoTime) {
  PlaybackClock clock(1.0, Real());
  clock.Set(100);
  now_ns_ += 10;
  clock.SetRate(3.0);
  EXPECT_EQ(clock.Now_ns(), 110);
  now_ns_ += 10;
  EXPECT_EQ(clock.Now_ns(), 140);
}

TEST_F(PlaybackClockTest, AtInfiniteRateNothingWaits) {
  PlaybackClock clock(std::numeric_limits<double>::infinity(), Real());
  clock.Set(100);
  EXPECT_EQ(clock.Until_ns(1'000'000'000), 0);
  EXPECT_EQ(clock.Now_ns(), 100);
  clock.Pause();
  EXPECT_EQ(clock.Until_ns(1'000'000'000), std::nullopt);
}

}  // namespace
}  // namespace palpate::player
