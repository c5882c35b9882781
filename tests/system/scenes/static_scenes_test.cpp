// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <cmath>

#include "tests/support/robots.hpp"
#include "tests/support/sensing/accuracy.hpp"
#include "tests/support/sensing/contact_generator.hpp"
#include "tests/support/sensing/sensing_chain.hpp"

/// Recordings that begin with a contact: one image of each.
namespace palpate::test_support {
namespace {

using Where = ContactWish::Where;

class StaticScenes : public testing::Test {
 protected:
  static constexpr int kLearningFrames = 20;
  static constexpr std::uint64_t kSeed = 5;

  StaticScenes()
      : scene_{FourLegRobot(), BallScenario(), kSeed},
        chain_{FourLegRobot(), scene_, {.eyes = ChainSettings::Eyes::kPerception}, kSeed} {
    chain_.Learn(kLearningFrames);
  }

  /// Each scene after another one: the model is where the robot was then.
  AccuracySummary LookOnce(ContactWish wish, int scenes) {
    wish.above_clamp_m = 0.045;
    wish.smallest_N = 0.4;
    wish.largest_N = 1.3;
    ContactGenerator generator(scene_, wish, kSeed);
    Accuracy accuracy;
    for (int k = 0; k < scenes; ++k) {
      EXPECT_TRUE(generator.Next());
      chain_.Open();
      accuracy.Add(scene_.state().forces, chain_.Take());
    }
    return accuracy.Summary();
  }

  SensingScene scene_;
  SensingChain chain_;
};

TEST_F(StaticScenes, ForcesInViewAreRightInTheFirstPicture) {
  const AccuracySummary seen = LookOnce({.where = Where::kVisible}, 5);
  EXPECT_EQ(seen.found_share, 1.0);
  EXPECT_LE(seen.mean_relative_error, 0.10);
  EXPECT_LE(seen.median_location_error_m, 0.004);
  EXPECT_EQ(seen.false_alarms, 0);
  EXPECT_GE(seen.force_coverage, 0.8);
}

/// The leg has moved aside by half its thickness: what touches its side lies where its top would
/// be if nothing pushed.
TEST(StaticScene, APushOnTheSideOfALegIsNoneOnItsTop) {
  constexpr std::uint64_t kSideSeed = 4;
  constexpr double kLargestCable_m = 0.003;
  SensingScene scene(FourLegRobot(), BallScenario(), kSideSeed);
  SensingChain chain(FourLegRobot(), scene, {.eyes = ChainSettings::Eyes::kPerception}, kSideSeed);
  chain.Learn(40, 4, kLargestCable_m);
  ASSERT_TRUE(scene.Start(scene.Nothing()).ok());
  ContactGenerator generator(scene, {.where = Where::kVisible, .largest_command = kLargestCable_m},
                             kSideSeed);
  ASSERT_TRUE(generator.Next());
  scene.Show(generator.path().back());
  chain.Open();
  const force_estimation::ForceEstimate& estimate = chain.Take();
  ASSERT_EQ(estimate.contacts.size(), 1U) << estimate.status.message() << ", seed " << kSideSeed;
  const Eigen::Vector3d push_N = generator.path().back().forces.front().force_N;
  ASSERT_GT(std::abs(push_N.y()), 0.9 * push_N.norm());
  EXPECT_LT((estimate.contacts[0].force_N - push_N).norm(), 0.2 * push_N.norm());
}

TEST_F(StaticScenes, ForcesOutOfViewAreFoundInTheFirstPicture) {
  const AccuracySummary hidden = LookOnce({.where = Where::kHidden}, 4);
  EXPECT_GE(hidden.found_share, 0.75);
  EXPECT_LE(hidden.median_location_error_m, 0.015);
  EXPECT_EQ(hidden.false_alarms, 0);
}

TEST_F(StaticScenes, NobodyTouchesIsSaidInTheFirstPictureAfterAPush) {
  ContactGenerator generator(scene_, {.where = Where::kVisible, .smallest_N = 1.0}, kSeed);
  ASSERT_TRUE(generator.Next());
  const SceneState pushed = scene_.state();
  for (int k = 0; k < 3; ++k) {
    scene_.Show(pushed);
    chain_.Open();
    EXPECT_FALSE(chain_.Take().contacts.empty());
    scene_.Show(generator.path().front());
    chain_.Open();
    const force_estimation::ForceEstimate& rest = chain_.Take();
    EXPECT_EQ(rest.status.code(), StatusCode::kNoContact) << rest.status.message();
  }
}

}  // namespace
}  // namespace palpate::test_support
