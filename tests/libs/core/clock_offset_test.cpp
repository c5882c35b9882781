// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/clock_offset.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace palpate {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kS = 1000 * kMs;

/// One exchange that begins at `time_ns`, with the other clock ahead by `offset_ns`.
ClockExchange Exchange(std::int64_t time_ns, std::int64_t offset_ns, std::int64_t there_ns,
                       std::int64_t back_ns, std::int64_t kept_ns = 300 * kMs) {
  return {.sent_ns = time_ns,
          .received_ns = time_ns + there_ns + offset_ns,
          .returned_ns = time_ns + there_ns + kept_ns + offset_ns,
          .returned_to_ns = time_ns + there_ns + kept_ns + back_ns};
}

TEST(ClockOffset, KnowsNothingBeforeTheFirstExchange) {
  EXPECT_FALSE(ClockOffsetFilter().At(0).has_value());
}

TEST(ClockOffset, EqualDelaysGiveTheOffsetExactly) {
  ClockOffsetFilter filter;
  ASSERT_TRUE(filter.Add(Exchange(0, 1500 * kMs, 2 * kMs, 2 * kMs)));
  const auto offset = filter.At(304 * kMs);
  ASSERT_TRUE(offset);
  EXPECT_NEAR(offset->offset_s, 1.5, 1e-12);
  EXPECT_NEAR(offset->bound_s, 2e-3, 1e-12);
}

TEST(ClockOffset, IsWithinItsBoundWhateverShareOneDirectionHas) {
  for (const std::int64_t there_ms : {0, 1, 5, 10}) {
    ClockOffsetFilter filter;
    ASSERT_TRUE(filter.Add(Exchange(0, -70 * kMs, there_ms * kMs, (10 - there_ms) * kMs)));
    const auto offset = filter.At(310 * kMs);
    EXPECT_LE(std::abs(offset->offset_s + 0.07), offset->bound_s + 1e-12) << there_ms;
  }
}

TEST(ClockOffset, TheFastestExchangeDecides) {
  ClockOffsetFilter filter;
  std::mt19937 random(1);
  std::exponential_distribution<double> queue(1.0 / 20e6);  // 20 ms
  for (int i = 0; i < 15; ++i) {
    const auto there_ns = static_cast<std::int64_t>(queue(random));
    ASSERT_TRUE(filter.Add(Exchange(i * kS, 5 * kMs, 200'000 + there_ns, 200'000)));
  }
  ASSERT_TRUE(filter.Add(Exchange(15 * kS, 5 * kMs, 200'000, 200'000)));
  EXPECT_NEAR(filter.At(16 * kS)->offset_s, 5e-3, 1e-9);
  EXPECT_LT(filter.At(16 * kS)->bound_s, 3e-4);
}

TEST(ClockOffset, ItsBoundGrowsWithTime) {
  ClockOffsetFilter filter;
  ASSERT_TRUE(filter.Add(Exchange(0, 0, kMs, kMs, 0)));
  EXPECT_NEAR(filter.At(102 * kS + 2 * kMs)->bound_s, 1e-3 + 102 * 50e-6, 1e-9);
}

TEST(ClockOffset, FollowsAClockThatIsSet) {
  ClockOffsetFilter filter;
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(filter.Add(Exchange(i * kS, 0, kMs / 10, kMs / 10)));
  ASSERT_TRUE(filter.Add(Exchange(10 * kS, 3 * kS, 4 * kMs, kMs)));
  EXPECT_NEAR(filter.At(11 * kS)->offset_s, 3.0, 3e-3);
}

TEST(ClockOffset, RefusesTimesThatContradictEachOther) {
  ClockOffsetFilter filter;
  EXPECT_FALSE(
      filter.Add({.sent_ns = 0, .received_ns = 10, .returned_ns = 5, .returned_to_ns = 20}));
  EXPECT_FALSE(
      filter.Add({.sent_ns = 0, .received_ns = 0, .returned_ns = 30, .returned_to_ns = 20}));
  EXPECT_FALSE(filter.At(0).has_value());
}

}  // namespace
}  // namespace palpate
