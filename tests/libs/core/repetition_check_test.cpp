// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/repetition_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

namespace palpate {
namespace {

/// Feeds a frame that has nothing but its mean.
bool Feed(RepetitionCheck& check, double mean) {
  return check.IsRepeated(std::to_string(mean), mean);
}

TEST(RepetitionCheck, FindsTheFirstCopyOfANoisySensor) {
  std::mt19937 random(1);
  std::normal_distribution<> noise;
  RepetitionCheck check;
  double last = 0.0;
  for (int frame = 0; frame < 60; ++frame) EXPECT_FALSE(Feed(check, last = noise(random)));
  EXPECT_TRUE(Feed(check, last));
  EXPECT_TRUE(Feed(check, last));
  EXPECT_FALSE(Feed(check, last + 1.0));
}

TEST(RepetitionCheck, FindsItAfterAMotionToo) {
  std::mt19937 random(1);
  std::normal_distribution<> noise;
  RepetitionCheck check;
  for (int frame = 0; frame < 60; ++frame) Feed(check, noise(random));
  for (int frame = 0; frame < 60; ++frame) EXPECT_FALSE(Feed(check, 10.0 * frame));
  EXPECT_TRUE(Feed(check, 590.0));
}

TEST(RepetitionCheck, LetsASensorWithoutNoiseRest) {
  RepetitionCheck check;
  double mean = 0.0;
  for (int frame = 0; frame < 300; ++frame) {
    mean = std::max(0.0, std::sin(0.05 * frame));  // moves and rests
    EXPECT_FALSE(Feed(check, mean)) << frame;
  }
}

TEST(RepetitionCheck, ForgetsASensor) {
  std::mt19937 random(1);
  std::normal_distribution<> noise;
  RepetitionCheck check;
  for (int frame = 0; frame < 60; ++frame) Feed(check, noise(random));
  check.Forget();
  Feed(check, 1.0);
  EXPECT_FALSE(Feed(check, 1.0));
}

}  // namespace
}  // namespace palpate
