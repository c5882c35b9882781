// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "components/force_estimation/force_estimate.hpp"
#include "libs/core/statistics.hpp"

namespace palpate::force_estimation {
namespace {

TEST(ForceInterval, OfALargeForceIsLinear) {
  const Eigen::Vector3d force_N(0.0, 3.0, 4.0);
  Eigen::Matrix3d covariance_N2 = Eigen::Vector3d(1e-3, 2e-3, 4e-3).asDiagonal();
  const double along_N2 = 0.36 * 2e-3 + 0.64 * 4e-3;
  EXPECT_NEAR(HalfWidth95_N(force_N, covariance_N2), kSigmas95 * std::sqrt(along_N2), 1e-12);
}

TEST(ForceInterval, ScalesWithForceAndSpread) {
  const Eigen::Vector3d force_N(0.1, 0.2, -0.1);
  const Eigen::Matrix3d covariance_N2 = Eigen::Vector3d(0.04, 0.01, 0.02).asDiagonal();
  const double once_N = HalfWidth95_N(force_N, covariance_N2);
  EXPECT_NEAR(HalfWidth95_N(10.0 * force_N, 100.0 * covariance_N2), 10.0 * once_N, 1e-9);
}

TEST(ForceInterval, ReachesZeroWhereNothingMayAct) {
  const Eigen::Matrix3d covariance_N2 = 0.04 * Eigen::Matrix3d::Identity();
  for (const double size_N : {0.05, 0.2, 0.4, 0.55}) {  // chi-squared below 9.3 of three degrees
    EXPECT_GE(HalfWidth95_N({0.0, size_N, 0.0}, covariance_N2), 0.999 * size_N) << size_N;
  }
  EXPECT_LT(HalfWidth95_N({0.0, 0.8, 0.0}, covariance_N2), 0.6);
}

TEST(ForceInterval, OfOneComponentIsThatOfTheComponent) {
  Eigen::Matrix3d covariance_N2 = Eigen::Matrix3d::Zero();
  covariance_N2(2, 2) = 0.01;
  EXPECT_NEAR(HalfWidth95_N({0.0, 0.0, 0.5}, covariance_N2), 0.1 * kSigmas95, 1e-12);
}

struct Case {
  double size_N;
  Eigen::Vector3d sigma_N;
};

/// Estimates about a true force: its size is within the interval as often as that says, also where
/// the force is small and its covariance long in one direction.
TEST(ForceInterval, HoldsTheTrueSize) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (const Case& one :
       {Case{0.0, {1.0, 1.0, 1.0}}, Case{0.5, {1.0, 1.0, 1.0}}, Case{1.0, {1.0, 1.0, 1.0}},
        Case{2.0, {1.0, 1.0, 1.0}}, Case{4.0, {1.0, 1.0, 1.0}}, Case{10.0, {1.0, 1.0, 1.0}},
        Case{1.0, {1.0, 0.1, 0.1}}, Case{1.0, {0.1, 1.0, 0.1}}, Case{3.0, {0.1, 1.0, 1.0}}}) {
    const Eigen::Vector3d force_N(one.size_N, 0.0, 0.0);
    const Eigen::Matrix3d covariance_N2 = one.sigma_N.cwiseAbs2().asDiagonal();
    constexpr int kDraws = 400;
    int held = 0;
    for (int draw = 0; draw < kDraws; ++draw) {
      Eigen::Vector3d estimate_N = force_N;
      for (Eigen::Index i = 0; i < 3; ++i) estimate_N[i] += one.sigma_N[i] * normal(random);
      const double half_N = HalfWidth95_N(estimate_N, covariance_N2);
      held += std::abs(estimate_N.norm() - one.size_N) <= half_N ? 1 : 0;
    }
    EXPECT_GE(held, 0.925 * kDraws)  // 0.95 less two standard deviations
        << one.size_N << " N, " << one.sigma_N.transpose();
  }
}

}  // namespace
}  // namespace palpate::force_estimation
