// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "components/force_estimation/shape/shape_average.hpp"
#include "tests/components/force_estimation/shape_scene.hpp"

namespace palpate::force_estimation {
namespace {

constexpr double kNoise_m = 1e-4;

/// Some features seen with the same noise.
class Average : public testing::Test {
 protected:
  Average() {
    CameraBiases bias(kFeatures, shape_);
    bias.HaveCameras(1);
    std::vector<correspondence::FeatureMatch> matches(kFeatures);
    for (correspondence::FeatureMatch& match : matches) {
      match.state = correspondence::MatchState::kMatched;
      match.sigma_m = kNoise_m;
      match.position_m = {0.0, 0.0, 0.4};
      match.normal = Eigen::Vector3d::UnitZ();
      match.row = {.nodes = {0}, .coefficients = {Eigen::Vector3d::UnitZ()}};
    }
    targets_.Build(matches, {}, bias, {Eigen::Isometry3d::Identity()}, Eigen::VectorXd::Zero(3),
                   Eigen::VectorXd::Zero(3), {});
  }

  void AddFrame(double motion_m) {
    std::normal_distribution<double> noise(0.0, kNoise_m);
    Eigen::VectorXd motions_m = Eigen::VectorXd::Constant(kFeatures, motion_m);
    for (double& value_m : motions_m) value_m += noise(random_);
    average_.Add(targets_, motions_m);
  }

  static constexpr int kFeatures = 40;
  ShapeConfig shape_;
  ShapeTargets targets_{shape_, 0.01};
  ShapeAverage average_;
  std::mt19937 random_{3};
};

TEST_F(Average, NoiseFallsWithTheFrames) {
  constexpr int kFrames = 16;
  for (int k = 0; k < kFrames; ++k) AddFrame(2e-3);
  EXPECT_EQ(average_.frames(), kFrames);
  const double off_m = (average_.motion_m().array() - 2e-3).matrix().norm() / std::sqrt(kFeatures);
  EXPECT_LT(off_m, 0.4 * kNoise_m);
  EXPECT_GT(average_.weight()[0], targets_.targets().weight[0]);
}

TEST_F(Average, WhatIsConstantStays) {
  AddFrame(0.0);
  const double constant_m2 =
      std::pow(targets_.sigma_m()[0], 2) - std::pow(targets_.noise_m()[0], 2);
  for (int k = 0; k < 50; ++k) AddFrame(0.0);
  EXPECT_LT(average_.weight()[0], 1.0 / constant_m2);
}

TEST_F(Average, WhatHasMovedBeginsAnew) {
  for (int k = 0; k < 5; ++k) AddFrame(0.0);
  AddFrame(10.0 * kNoise_m);
  EXPECT_EQ(average_.frames(), 1);
  EXPECT_NEAR(average_.motion_m().mean(), 10.0 * kNoise_m, kNoise_m);
}

}  // namespace
}  // namespace palpate::force_estimation
