// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/seconds.hpp"

#include <gtest/gtest.h>

namespace palpate {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::steady_clock;

TEST(Seconds, AreTheSameThereAndBack) {
  EXPECT_DOUBLE_EQ(ToSeconds(milliseconds(1500)), 1.5);
  EXPECT_EQ(FromSeconds(1.5), milliseconds(1500));
  EXPECT_EQ(FromSeconds(-2e-9), nanoseconds(-2));
  EXPECT_EQ(FromSeconds(1.9e-9), nanoseconds(1)) << "rounded towards zero";
  EXPECT_DOUBLE_EQ(NsToSeconds(-2'500'000'000), -2.5);
}

TEST(Seconds, SinceALaterInstantAreNegative) {
  EXPECT_GE(SecondsSince(steady_clock::now()), 0.0);
  EXPECT_LT(SecondsSince(steady_clock::now() + std::chrono::hours(1)), -3500.0);
}

}  // namespace
}  // namespace palpate
