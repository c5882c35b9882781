// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "tests/support/robots.hpp"
#include "tests/support/sensing/contact_generator.hpp"
#include "tests/support/sensing/sensing_chain.hpp"
#include "tests/support/sensing/watch.hpp"

/// A second camera sees what is hidden from the first.
namespace palpate::test_support {
namespace {

class TwoCameraScene : public testing::Test {
 protected:
  static constexpr int kLearningFrames = 20;
  static constexpr std::uint64_t kSeed = 5;

  static scenario::Scenario Bench() {
    scenario::Scenario scenario = BallScenario();
    scenario.further_cameras = OppositeCamera();
    return scenario;
  }

  /// A chain that has learnt its depth biases, before the scene at rest.
  std::unique_ptr<SensingChain> ChainOf(std::size_t cameras) {
    ChainSettings settings;
    settings.eyes = ChainSettings::Eyes::kPerception;
    settings.cameras = cameras;
    auto chain = std::make_unique<SensingChain>(FourLegRobot(), scene_, settings, kSeed);
    chain->Learn(kLearningFrames);
    EXPECT_TRUE(scene_.Start(scene_.Nothing()).ok());
    return chain;
  }

  SensingScene scene_{FourLegRobot(), Bench(), kSeed};
};

TEST_F(TwoCameraScene, HalveTheErrorOfContactsThatAreHiddenFromTheFirst) {
  constexpr int kContacts = 4;
  std::vector<std::vector<SceneState>> paths;
  ContactGenerator generator(scene_, {.where = ContactWish::Where::kHidden}, kSeed);
  while (std::ssize(paths) < kContacts && generator.Next()) paths.push_back(generator.path());
  ASSERT_EQ(std::ssize(paths), kContacts);
  double error[2] = {};
  for (const std::size_t cameras : {1u, 2u}) {
    const auto chain = ChainOf(cameras);
    Watched watched;
    for (const auto& path : paths) Watch(path, {}, scene_, *chain, &watched);
    const AccuracySummary held = watched.held.Summary();
    error[cameras - 1] = held.mean_relative_error;
    if (cameras == 1) continue;
    EXPECT_EQ(held.found_share, 1.0);
    EXPECT_EQ(held.failed_frames, 0);
  }
  EXPECT_LE(error[1], 0.5 * error[0]);
}

/// While the contact is held the other camera drops out, then the one that sees it. Without that
/// one the contact is hidden, and may be too small to be found; once it is back, so is the force.
TEST_F(TwoCameraScene, AreLessExactWhereOneDropsOutButGoOn) {
  ContactGenerator generator(scene_, {.where = ContactWish::Where::kHidden}, kSeed);
  ASSERT_TRUE(generator.Next());
  const std::vector<SceneState> path = generator.path();
  const auto chain = ChainOf(2);
  std::size_t missing = 2;
  chain->SetFaults({.images = {},
                    .is_missing = [&missing](std::size_t camera) { return camera == missing; },
                    .cables = {}});
  const auto look = [&](const SceneState& state) {
    scene_.Show(state);
    const force_estimation::ForceEstimate& estimate = chain->Take();
    EXPECT_TRUE(estimate.status.ok() || estimate.status.code() == StatusCode::kNoContact)
        << estimate.status.message();
    return estimate.contacts.empty() ? 0.0 : estimate.contacts[0].force_N.norm();
  };
  for (const SceneState& state : path) look(state);
  const double true_N = path.back().forces.at(0).force_N.norm();
  constexpr std::size_t kNone = 2;
  constexpr std::size_t kTheOneThatSees = 1;
  for (const std::size_t camera : {kNone, std::size_t{0}, kTheOneThatSees, kNone}) {
    missing = camera;
    double force_N = 0.0;
    for (int k = 0; k < 8; ++k) force_N = look(path.back());
    if (camera == kTheOneThatSees) continue;
    EXPECT_NEAR(force_N, true_N, 0.3 * true_N) << "without camera " << camera;
  }
}

}  // namespace
}  // namespace palpate::test_support
