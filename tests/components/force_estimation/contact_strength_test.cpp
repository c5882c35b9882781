// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "components/force_estimation/shape/contact_report.hpp"
#include "libs/core/statistics.hpp"

namespace palpate::force_estimation {
namespace {

constexpr double kChance = 1e-6;
constexpr double kSigma_N = 0.02;
const Eigen::Vector3d kNormal = Eigen::Vector3d::UnitZ();

Eigen::Matrix3d Spread_N2() {
  Eigen::Matrix3d spread_N2 = (Eigen::Vector3d(4.0, 2.0, 1.0) * kSigma_N * kSigma_N).asDiagonal();
  spread_N2(0, 2) = spread_N2(2, 0) = 0.5 * kSigma_N * kSigma_N;
  return spread_N2;
}

TEST(ContactStrength, IsTheSameInEveryFrame) {
  const Eigen::Vector3d force_N(0.08, -0.05, -0.03);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  for (const bool hidden : {false, true}) {
    const double here = Strength(force_N, Spread_N2(), kNormal, hidden, kChance);
    const double turned = Strength(turn * force_N, turn * Spread_N2() * turn.transpose(),
                                   turn * kNormal, hidden, kChance);
    EXPECT_GT(here, 0.0);
    EXPECT_NEAR(turned, here, 1e-12 * here) << hidden;
  }
}

TEST(ContactStrength, GrowsWithTheForceAndIsOneWhereNoiseExceedsItWithTheChance) {
  const double least_N = NormalQuantile(1.0 - kChance) * kSigma_N;
  const Eigen::Vector3d push_N = -least_N * kNormal;
  EXPECT_NEAR(Strength(push_N, Spread_N2(), kNormal, false, kChance), 1.0, 1e-12);
  EXPECT_NEAR(Strength(3.0 * push_N, Spread_N2(), kNormal, false, kChance), 3.0, 1e-12);
  const double whole_N = std::sqrt(ChiSquaredQuantile(1.0 - kChance, 3)) * kSigma_N;
  const Eigen::Matrix3d even_N2 = kSigma_N * kSigma_N * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d aslant = Eigen::Vector3d(3.0, 0.0, -1.0).normalized();
  EXPECT_NEAR(Strength(whole_N * aslant, even_N2, kNormal, true, kChance), 1.0, 1e-12);
}

/// On an edge the patch faces between both sides, and the force may push on one of them.
TEST(ContactStrength, CountsAllOfAForceThatNobodySeesOnAnEdge) {
  const Eigen::Matrix3d even_N2 = kSigma_N * kSigma_N * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d on_one_side_N = 10.0 * kSigma_N * Eigen::Vector3d(1.0, 0.0, -0.1);
  EXPECT_GT(Strength(on_one_side_N, even_N2, kNormal, true, kChance), 1.0);
  EXPECT_LT(Strength(on_one_side_N, even_N2, kNormal, false, kChance), 0.5);
}

TEST(ContactStrength, IsNoneOfAPull) {
  const Eigen::Vector3d pull_N = 10.0 * kSigma_N * Eigen::Vector3d(1.0, 0.0, 0.1);
  for (const bool hidden : {false, true}) {
    EXPECT_LE(Strength(pull_N, Spread_N2(), kNormal, hidden, kChance), 0.0) << hidden;
  }
}

}  // namespace
}  // namespace palpate::force_estimation
