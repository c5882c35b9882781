// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>

#include "components/force_estimation/shape/hidden_search.hpp"
#include "tests/components/force_estimation/hidden_scene.hpp"

namespace palpate::force_estimation {
namespace {

/// The beam, seen from above and one side.
class HiddenSearchOnBeam : public testing::Test {
 protected:
  HiddenSearchOnBeam() : scene_(Robot(), {0.1, 0.4, 0.3}, {-0.05, 0.015, 0.015}) {
    EXPECT_TRUE(scene_.Respond().ok());
    EXPECT_GT(scene_.rows.size(), 15U);
  }

  static robot::RobotDescription Robot() {
    robot::RobotDescription robot = BeamRobot();
    robot.feature_point_count = 60;
    return robot;
  }
  /// A push along the inward normal.
  HiddenScene::Push PushAt(const Eigen::Vector3d& place_m, double force_N) const {
    const fem::SurfacePatch patch = scene_.model.Patch(place_m, HiddenScene::kRadius_m);
    return {place_m, -force_N * patch.normal, force_N};
  }
  /// What `push` does to the rows, to first order, without noise.
  Eigen::VectorXd Response_m(HiddenScene::Push push) {
    constexpr double kSmall = 1e-3;
    push.force_N *= kSmall;
    const Eigen::VectorXd shift_m = scene_.Motion_m({push});
    return shift_m / kSmall;
  }

  HiddenScene scene_;
  std::mt19937 random_{4};
};

const Eigen::Vector3d kBelow(-0.02, 0.012, 0.0);
const Eigen::Vector3d kBehind(-0.045, 0.0, 0.018);

TEST_F(HiddenSearchOnBeam, FindsASmallPushWhereItIs) {
  for (const Eigen::Vector3d& place_m : {kBelow, kBehind}) {
    const double force_N = place_m == kBelow ? 0.03 : 0.15;
    const Unexplained data = scene_.Observe({PushAt(place_m, force_N)}, random_);
    const auto& found = scene_.search->Find(data, 2, 1e-6, {}, 0.0);
    ASSERT_EQ(found.size(), 1U);
    const double off_m = (found[0].rest_position_m - place_m).norm();
    EXPECT_LT(off_m, 0.008) << found[0].rest_position_m.transpose();
    EXPECT_LE(off_m, found[0].location_ci95_m);
    EXPECT_NEAR(found[0].force_N, force_N, 0.2 * force_N);
    EXPECT_GT(std::sqrt(found[0].location_covariance_m2.trace()), 0.2 * found[0].location_ci95_m);
  }
}

TEST_F(HiddenSearchOnBeam, TellsTheGainThatTheContactBrings) {
  const Unexplained data = scene_.Observe({PushAt(kBelow, 0.05)}, random_);
  const auto& found = scene_.search->Find(data, 1, 1e-6, {}, 0.0);
  ASSERT_EQ(found.size(), 1U);
  const double whole = data.weight.dot(data.residual_m.cwiseAbs2());
  const double left = whole - found[0].chi_squared_gain;
  EXPECT_GT(left, 0.3 * static_cast<double>(scene_.rows.size()));
  EXPECT_LT(left, 2.0 * static_cast<double>(scene_.rows.size()));
}

TEST_F(HiddenSearchOnBeam, NothingPulls) {
  HiddenScene::Push pull = PushAt({-0.01, 0.015, 0.03}, 0.05);
  pull.force_N *= -1.0;  // up at the top: as a push from below
  const auto& found = scene_.search->Find(scene_.Observe({pull}, random_), 1, 1e-6, {}, 0.0);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_GT(found[0].force_N, 0.0);
  EXPECT_LT(found[0].rest_position_m.z(), 0.015);
}

/// From both sides, so that the tip hardly moves, to first order and well above the noise.
TEST_F(HiddenSearchOnBeam, FindsTwoPushesAtOnce) {
  const std::vector<HiddenScene::Push> pushes = {PushAt(kBehind, 2.0),
                                                 PushAt({-0.01, 0.03, 0.015}, 0.8)};
  Unexplained data = scene_.Noise(random_);
  data.residual_m *= 0.1;
  data.weight *= 100.0;
  for (const HiddenScene::Push& push : pushes) data.residual_m += Response_m(push);
  data.left_m = Eigen::VectorXd::Zero(data.residual_m.size());
  const auto& found = scene_.search->Find(data, 2, 1e-6, {}, 0.0);
  ASSERT_EQ(found.size(), 2U);
  for (const HiddenScene::Push& push : pushes) {
    const auto off_m = [&](const HiddenContact& contact) {
      return (contact.rest_position_m - push.place_m).norm();
    };
    const HiddenContact& contact = off_m(found[0]) < off_m(found[1]) ? found[0] : found[1];
    EXPECT_LT(off_m(contact), 0.01) << contact.rest_position_m.transpose();
    EXPECT_GT(contact.force_N, 0.5 * push.normal_N);
    EXPECT_LT(contact.force_N, 2.0 * push.normal_N);
  }
  EXPECT_EQ(scene_.search->Find(data, 1, 1e-6, {}, 0.0).size(), 1U);
}

TEST_F(HiddenSearchOnBeam, KnownForcesAreRefittedAlong) {
  Unexplained data = scene_.Noise(random_);
  const Eigen::VectorXd known_m = Response_m(PushAt({-0.03, 0.015, 0.03}, 1.0));
  data.residual_m += 0.1 * known_m;
  EXPECT_FALSE(scene_.search->Find(data, 2, 1e-6, {}, 0.0).empty());
  data.known = known_m;
  EXPECT_TRUE(scene_.search->Find(data, 2, 1e-6, {}, 0.0).empty());
}

TEST_F(HiddenSearchOnBeam, TakenPlacesAreLeftOut) {
  const Unexplained data = scene_.Observe({PushAt(kBelow, 0.05)}, random_);
  const auto& found = scene_.search->Find(data, 1, 1e-6, {kBelow}, 0.02);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_GT((found[0].rest_position_m - kBelow).norm(), 0.02);
}

TEST_F(HiddenSearchOnBeam, RespondsAtAPlaceAsTheEquilibriumDoes) {
  HiddenScene::Push push = PushAt(kBehind, 1.0);
  push.force_N = {0.2, 1.0, -0.5};
  const Eigen::VectorXd wanted_m = Response_m(push);
  const Eigen::VectorXd made_m = scene_.ResponseAt(kBehind) * push.force_N;
  EXPECT_LT((made_m - wanted_m).norm(), 0.01 * wanted_m.norm());
}

TEST_F(HiddenSearchOnBeam, FalseAlarmsAreAsRareAsAskedFor) {
  constexpr int kFrames = 3000;
  constexpr double kSignificance = 0.01;
  const double threshold = scene_.search->Threshold_sigmas(scene_.Noise(random_), kSignificance);
  EXPECT_GT(threshold, 2.33);
  EXPECT_LT(threshold, 4.1);
  int alarms = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    const Unexplained noise = scene_.Noise(random_);
    alarms += scene_.search->Find(noise, 2, kSignificance, {}, 0.0).empty() ? 0 : 1;
  }
  EXPECT_GT(alarms, 0.5 * kSignificance * kFrames);
  EXPECT_LT(alarms, 1.5 * kSignificance * kFrames);
}

/// A push of as many sigmas as Find asks for is found every other time.
TEST_F(HiddenSearchOnBeam, SigmaAndThresholdTellTheSmallestForce) {
  constexpr double kSignificance = 1e-4;
  Unexplained data = scene_.Noise(random_);
  const double sigma_N = scene_.search->SigmaOfForce_N(data, kBelow);
  const double smallest_N = sigma_N * scene_.search->Threshold_sigmas(data, kSignificance);
  const Eigen::VectorXd response_m = Response_m(PushAt(kBelow, smallest_N));
  EXPECT_NEAR(response_m.norm() / HiddenScene::kSigma_m * sigma_N / smallest_N, 1.0, 0.1);
  const auto found = [&](double factor) {
    int count = 0;
    for (int trial = 0; trial < 100; ++trial) {
      Unexplained noisy = scene_.Noise(random_);
      noisy.residual_m += factor * response_m;
      count += scene_.search->Find(noisy, 1, kSignificance, {}, 0.0).empty() ? 0 : 1;
    }
    return count;
  };
  EXPECT_GT(found(1.0), 30);
  EXPECT_LT(found(1.0), 85);
  EXPECT_GT(found(1.7), 95);
  EXPECT_LT(found(0.4), 15);
}

TEST_F(HiddenSearchOnBeam, TenMinutesOfRestGiveNoAlarm) {
  constexpr int kFrames = 18000;
  int alarms = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    alarms += scene_.search->Find(scene_.Noise(random_), 2, 1e-6, {}, 0.0).empty() ? 0 : 1;
  }
  EXPECT_EQ(alarms, 0);
}

}  // namespace
}  // namespace palpate::force_estimation
