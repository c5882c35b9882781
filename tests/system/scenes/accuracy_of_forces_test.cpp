// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <numbers>

#include "tests/support/robots.hpp"
#include "tests/support/sensing/contact_generator.hpp"
#include "tests/support/sensing/paths.hpp"
#include "tests/support/sensing/watch.hpp"

namespace palpate::test_support {
namespace {

using Eyes = ChainSettings::Eyes;
using Where = ContactWish::Where;

/// A small sample of what palpate-bench measures in full (tests/benchmarks/sensing_bench.hpp), with
/// the limits of the issue widened by what so few contacts scatter. Places below 40 mm are left
/// out: there the legs hardly move, and single forces err by tens of percent.
class Forces : public testing::TestWithParam<Eyes> {
 protected:
  static constexpr int kLearningFrames = 12;
  static constexpr double kDegree = std::numbers::pi / 180.0;

  Forces()
      : scene_{FourLegRobot(), BallScenario(), 1}, chain_{FourLegRobot(), scene_, Settings(), 1} {
    chain_.Learn(kLearningFrames);
  }

  static ChainSettings Settings() {
    ChainSettings settings;
    settings.eyes = GetParam();
    return settings;
  }

  AccuracySummary Touch(ContactWish wish, int contacts) {
    wish.above_clamp_m = 0.04;
    wish.smallest_N = 0.5;
    wish.largest_N = 1.2;
    ContactGenerator generator(scene_, wish, 1);
    Watched watched;
    for (int k = 0; k < contacts; ++k) {
      EXPECT_TRUE(generator.Next());
      Watch(generator.path(), {.settle = 3, .measured = 3, .rest = 1}, scene_, chain_, &watched);
    }
    return watched.held.Summary();
  }

  void NobodyTouches() {
    ASSERT_TRUE(scene_.Start(scene_.Nothing()).ok());
    scenario::Random random(1, "hand");
    Accuracy alarms;
    for (int k = 0; k < 8; ++k) alarms.Add({}, chain_.Take());
    for (const SceneState& state : HandComesNear(scene_, 0.010, 8, &random)) {
      scene_.Show(state);
      alarms.Add({}, chain_.Take());
    }
    EXPECT_EQ(alarms.Summary().false_alarms, 0);
    EXPECT_EQ(alarms.Summary().failed_frames, 0);
  }

  SensingScene scene_;
  SensingChain chain_;
};

INSTANTIATE_TEST_SUITE_P(Behind, Forces, testing::Values(Eyes::kIdeal, Eyes::kPerception),
                         [](const auto& eyes) {
                           return eyes.param == Eyes::kIdeal ? "IdealPerception" : "Perception";
                         });

TEST_P(Forces, AreRightWhereTheyAreSeenAndNoneWhereNobodyTouches) {
  NobodyTouches();
  const AccuracySummary seen = Touch({.where = Where::kVisible}, 3);
  EXPECT_EQ(seen.found_share, 1.0);
  EXPECT_LE(seen.mean_relative_error, 0.10);
  EXPECT_LE(seen.median_relative_error, 0.07);
  EXPECT_LE(seen.median_location_error_m, 0.004);
  EXPECT_GT(seen.directions, 0);
  EXPECT_LE(seen.mean_direction_error_rad, 10.0 * kDegree);
  EXPECT_GE(seen.force_coverage, 0.6);
}

TEST_P(Forces, AreFoundWhereNobodySeesThem) {
  const AccuracySummary hidden = Touch({.where = Where::kHidden}, 2);
  EXPECT_GE(hidden.found_share, 0.5);
  EXPECT_LE(hidden.median_location_error_m, 0.02);
}

}  // namespace
}  // namespace palpate::test_support
