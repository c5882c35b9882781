// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "components/force_estimation/shape/force_filter.hpp"
#include "tests/components/force_estimation/test_bodies.hpp"

namespace palpate::force_estimation {
namespace {

const Eigen::Vector3d kHeldForce_N(0.1, -0.4, -0.8);

Eigen::Matrix3d Noise(double sigma_N) { return sigma_N * sigma_N * Eigen::Matrix3d::Identity(); }

TEST(ForceFilter, TheFirstFrameStandsAsItIs) {
  ForceFilter filter(2.0);
  filter.Update(5.0, kHeldForce_N, Noise(0.1));
  EXPECT_EQ(filter.force_N(), kHeldForce_N);
  EXPECT_EQ(filter.covariance_N2(), Noise(0.1));
}

TEST(ForceFilter, WithoutARateEachFrameStandsForItself) {
  ForceFilter filter(0.0);
  filter.Update(0.0, kHeldForce_N, Noise(0.1));
  filter.Update(0.1, 1.1 * kHeldForce_N, Noise(0.1));
  EXPECT_EQ(filter.force_N(), 1.1 * kHeldForce_N);
}

TEST(ForceFilter, NoiseIsAveragedToWhatItsCovarianceSays) {
  constexpr double kSigma_N = 0.2;
  std::mt19937 random(1);
  double sum = 0.0;
  ForceFilter filter(0.3);
  constexpr int kFrames = 3000;
  constexpr int kSettled = 100;
  for (int k = 0; k < kFrames; ++k) {
    filter.Update(k / 30.0, kHeldForce_N + NormalNoise(kSigma_N, random), Noise(kSigma_N));
    if (k >= kSettled) sum += (filter.force_N() - kHeldForce_N).squaredNorm() / 3.0;
  }
  const double scatter_N = std::sqrt(sum / (kFrames - kSettled));
  EXPECT_LT(scatter_N, 0.4 * kSigma_N);
  // The walk that it allows for did not happen: it is better than it says, within a factor.
  EXPECT_LT(scatter_N, std::sqrt(filter.covariance_N2()(0, 0)));
  EXPECT_GT(scatter_N, 0.4 * std::sqrt(filter.covariance_N2()(0, 0)));
}

TEST(ForceFilter, AnAccurateForceIsFollowedAtOnce) {
  constexpr double kSigma_N = 0.003;
  ForceFilter filter(2.0);
  for (int k = 0; k <= 30; ++k) {
    filter.Update(k / 30.0, k / 30.0 * kHeldForce_N, Noise(kSigma_N));  // 0.9 N in a second
  }
  EXPECT_LT((filter.force_N() - kHeldForce_N).norm(), kSigma_N);
}

TEST(ForceFilter, AHeldForceIsAveragedMoreThanAChangingOne) {
  constexpr double kSigma_N = 0.1;
  constexpr double kRate_N_s = 2.0;
  constexpr int kFrames = 60;
  constexpr int kRuns = 50;
  std::mt19937 random(3);
  double held_N2 = 0.0;
  double inside = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    ForceFilter filter(kRate_N_s);
    for (int k = 0; k < kFrames; ++k) {
      filter.Update(k / 30.0, kHeldForce_N + NormalNoise(kSigma_N, random), Noise(kSigma_N));
    }
    const double off_N = filter.force_N().z() - kHeldForce_N.z();
    held_N2 += off_N * off_N / kRuns;
    inside += std::abs(off_N) <= 1.96 * std::sqrt(filter.covariance_N2()(2, 2)) ? 1.0 / kRuns : 0.0;
  }
  // The fast walk alone would leave 0.7 of the noise over.
  EXPECT_LT(std::sqrt(held_N2), 0.45 * kSigma_N);
  EXPECT_GE(inside, 0.88);
}

TEST(ForceFilter, ARampIsFollowedWithinWhatItsCovarianceSays) {
  constexpr double kSigma_N = 0.05;
  constexpr int kRuns = 50;
  const Eigen::Vector3d rise_N_s(0.0, 0.0, -1.0);
  std::mt19937 random(4);
  double inside = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    ForceFilter filter(2.0);
    for (int k = 0; k < 30; ++k) {
      filter.Update(k / 30.0, NormalNoise(kSigma_N, random), Noise(kSigma_N));
    }
    Eigen::Vector3d true_N = Eigen::Vector3d::Zero();
    for (int k = 30; k < 45; ++k) {
      true_N = (k - 30) / 30.0 * rise_N_s;
      filter.Update(k / 30.0, true_N + NormalNoise(kSigma_N, random), Noise(kSigma_N));
    }
    const double off_N = filter.force_N().z() - true_N.z();
    inside += std::abs(off_N) <= 1.96 * std::sqrt(filter.covariance_N2()(2, 2)) ? 1.0 / kRuns : 0.0;
  }
  EXPECT_GE(inside, 0.8);
}

TEST(ForceFilter, AJumpRestarts) {
  ForceFilter filter(0.1);
  for (int k = 0; k < 30; ++k) filter.Update(k / 30.0, kHeldForce_N, Noise(0.02));
  filter.Update(1.0, -kHeldForce_N, Noise(0.02));
  EXPECT_EQ(filter.force_N(), -kHeldForce_N);
}

TEST(ForceFilter, ASmallerThresholdOfChangeFollowsASmallerJump) {
  const Eigen::Vector3d jump_N(0.0, 0.0, 0.06);  // three sigmas of a frame
  ForceFilter by_default(0.1), sensitive(0.1, {.changed_chi_squared = 4.0});
  for (ForceFilter* filter : {&by_default, &sensitive}) {
    for (int k = 0; k < 30; ++k) filter->Update(k / 30.0, kHeldForce_N, Noise(0.02));
    filter->Update(1.0, kHeldForce_N + jump_N, Noise(0.02));
  }
  EXPECT_EQ(sensitive.force_N(), kHeldForce_N + jump_N);
  EXPECT_LT((by_default.force_N() - kHeldForce_N).norm(), 0.5 * jump_N.norm())
      << "averaged as noise";
}

TEST(ForceFilter, TurnsWithTheFrame) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  const Eigen::Matrix3d covariance = Eigen::Vector3d(1e-2, 1e-4, 4e-3).asDiagonal();
  ForceFilter filter(0.5), turned(0.5);
  std::mt19937 random(2);
  for (int k = 0; k < 20; ++k) {
    const Eigen::Vector3d force_N = kHeldForce_N + NormalNoise(0.01, random);
    filter.Update(k / 30.0, force_N, covariance);
    turned.Update(k / 30.0, turn * force_N, turn * covariance * turn.transpose());
  }
  EXPECT_LT((turn * filter.force_N() - turned.force_N()).norm(), 1e-12);
}

}  // namespace
}  // namespace palpate::force_estimation
