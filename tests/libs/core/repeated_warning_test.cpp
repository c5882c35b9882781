// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/repeated_warning.hpp"

#include <gmock/gmock.h>

namespace palpate {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Optional;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// A log whose clock the test sets.
struct Warnings {
  std::int64_t now_ns = 7 * kSecond_ns;
  RepeatedWarning warnings{10.0, [this] { return now_ns; }};
};

TEST(RepeatedWarning, TheFirstOfAKindIsDueAtOnceWithWhatTellsIt) {
  Warnings log;
  EXPECT_THAT(log.warnings.Add("cloud refused: no joint state", "stamp 1.5 s"),
              Optional(std::string("cloud refused: no joint state (stamp 1.5 s)")));
  EXPECT_THAT(log.warnings.Add("another", ""), Optional(std::string("another")));
}

TEST(RepeatedWarning, FurtherOnesAreCountedAndDueAfterThePeriod) {
  Warnings log;
  ASSERT_TRUE(log.warnings.Add("refused", "stamp 1 s"));
  for (int i = 2; i <= 20; ++i) {
    EXPECT_EQ(log.warnings.Add("refused", "stamp " + std::to_string(i) + " s"), std::nullopt);
    EXPECT_THAT(log.warnings.TakeDue(), IsEmpty());
  }
  log.now_ns += 10 * kSecond_ns;
  EXPECT_THAT(log.warnings.TakeDue(),
              ElementsAre("refused (19 times in the last 10 s, last stamp 20 s)"));
  EXPECT_THAT(log.warnings.TakeDue(), IsEmpty());
}

TEST(RepeatedWarning, NoneIsLostWhereTheyGoOnAndOn) {
  Warnings log;
  std::uint64_t said = 0;
  for (int i = 0; i < 1000; ++i) {
    said += log.warnings.Add("refused", "") ? 1 : 0;
    log.now_ns += kSecond_ns / 30;
    for (const std::string& line : log.warnings.TakeDue()) {
      said += std::stoull(line.substr(line.find('(') + 1));
    }
  }
  log.now_ns += 10 * kSecond_ns;
  for (const std::string& line : log.warnings.TakeDue()) {
    said += std::stoull(line.substr(line.find('(') + 1));
  }
  EXPECT_EQ(said, 1000u);
}

TEST(RepeatedWarning, AfterAQuietPeriodTheNextIsDueAtOnceAgain) {
  Warnings log;
  ASSERT_TRUE(log.warnings.Add("refused", ""));
  log.now_ns += 9 * kSecond_ns;
  EXPECT_FALSE(log.warnings.Add("refused", ""));
  log.now_ns += kSecond_ns;
  EXPECT_THAT(log.warnings.TakeDue(), ElementsAre("refused (1 time in the last 10 s)"));
  log.now_ns += 10 * kSecond_ns;
  EXPECT_THAT(log.warnings.TakeDue(), IsEmpty());
  EXPECT_TRUE(log.warnings.Add("refused", ""));
}

TEST(RepeatedWarning, NumbersMakeNoNewKindButNamesDo) {
  Warnings log;
  EXPECT_TRUE(log.warnings.Add("the frame is 0.52 s old", ""));
  EXPECT_FALSE(log.warnings.Add("the frame is 12.5e-3 s old", ""));
  EXPECT_TRUE(log.warnings.Add("cable_1 is slack", ""));
  EXPECT_TRUE(log.warnings.Add("cable_2 is slack", ""));
  EXPECT_EQ(WithoutNumbers("a 640 x 480 image, 1.5e-05 m, v2"), "a # x # image, # m, v2");
}

TEST(RepeatedWarning, KindsBeyondTheLimitPushOutTheOldest) {
  Warnings log;
  const auto name = [](int i) { return std::string(static_cast<std::size_t>(i + 1), 'a'); };
  for (int i = 0; i < 33; ++i) ASSERT_TRUE(log.warnings.Add(name(i), ""));
  EXPECT_FALSE(log.warnings.Add(name(1), ""));
  EXPECT_TRUE(log.warnings.Add(name(0), ""));
}

}  // namespace
}  // namespace palpate
