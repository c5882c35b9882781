// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/error_consistency.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>
#include <string>

#include "tests/support/not_a_number.hpp"

namespace palpate::force_estimation {
namespace {

Eigen::Matrix3d SomeCovariance_N2() {
  Eigen::Matrix3d covariance_N2;
  covariance_N2 << 4.0, 1.0, 0.5, 1.0, 2.0, -0.3, 0.5, -0.3, 0.5;
  return covariance_N2;
}

TEST(NormalisedError, IsTheSquaredDistanceInStandardDeviations) {
  const Eigen::Vector3d error_N(0.4, 0.3, -0.2);
  const Eigen::Matrix3d covariance_N2 = Eigen::Vector3d(0.16, 0.01, 0.04).asDiagonal();
  const NormalisedError error = Normalise(error_N, covariance_N2);
  EXPECT_EQ(error.degrees, 3);
  EXPECT_NEAR(error.squared, 1.0 + 9.0 + 1.0, 1e-9);
  EXPECT_FALSE(error.IsWithin95());
  EXPECT_TRUE(Normalise(0.8 * error_N, covariance_N2).IsWithin95());
  const Eigen::Vector3d other_N(1.0, -2.0, 0.1);
  EXPECT_NEAR(Normalise(other_N, SomeCovariance_N2()).squared,
              other_N.dot(SomeCovariance_N2().inverse() * other_N), 1e-9);
}

TEST(NormalisedError, CountsTheDirectionsThatHaveAVariance) {
  const Eigen::Vector3d along(0.0, 0.6, 0.8);
  const Eigen::Matrix3d covariance_N2 = 0.04 * along * along.transpose();
  const NormalisedError error = Normalise(0.6 * along, covariance_N2);
  EXPECT_EQ(error.degrees, 1);
  EXPECT_NEAR(error.squared, 9.0, 1e-9);
  EXPECT_EQ(Normalise(along, Eigen::Matrix3d::Zero()).degrees, 0);
  EXPECT_EQ(Normalise(along, Eigen::Matrix3d::Constant(kNaN)).degrees, 0);
  EXPECT_FALSE(Normalise(along, Eigen::Matrix3d::Zero()).IsWithin95());
}

TEST(ErrorConsistency, CountsEachContactOnce) {
  ErrorConsistency found;
  EXPECT_TRUE(std::isnan(found.NeesPerDegree()));
  EXPECT_TRUE(std::isnan(found.HighestExpected()));
  for (int frame = 0; frame < 9; ++frame) found.Add("held for long", {3.0, 3});
  found.Add("held for a frame", {9.0, 3});
  found.Add("without a covariance", {0.0, 0});
  EXPECT_EQ(found.contacts(), 2);
  EXPECT_EQ(found.forces(), 10);
  EXPECT_NEAR(found.NeesPerDegree(), 0.5 * (1.0 + 3.0), 1e-12);
  EXPECT_NEAR(found.ShareWithin95(), 0.5, 1e-12);
  EXPECT_NEAR(found.HighestExpected(), 14.45 / 6.0, 0.05);  // of six degrees of freedom
  EXPECT_NEAR(found.LowestExpected(), 1.237 / 6.0, 0.02);
}

/// Of true covariances in 19 of 20 sets; of those that are off by a factor of 2, in none of 40.
TEST(ErrorConsistency, TellsCovariancesThatAreOffByAFactorOfTwo) {
  const Eigen::Matrix3d root_N = Eigen::LLT<Eigen::Matrix3d>(SomeCovariance_N2()).matrixL();
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, 1.0);
  constexpr int kSets = 40;
  const auto is_expected = [](const ErrorConsistency& found) {
    return found.NeesPerDegree() >= found.LowestExpected() &&
           found.NeesPerDegree() <= found.HighestExpected();
  };
  int held = 0;
  for (int set = 0; set < kSets; ++set) {
    ErrorConsistency as_it_is, halved, doubled;
    for (int k = 0; k < 60; ++k) {
      const double x = normal(random), y = normal(random);
      const Eigen::Vector3d error_N = root_N * Eigen::Vector3d(x, y, normal(random));
      const std::string name = std::to_string(k);
      as_it_is.Add(name, Normalise(error_N, SomeCovariance_N2()));
      halved.Add(name, Normalise(error_N, 0.5 * SomeCovariance_N2()));
      doubled.Add(name, Normalise(error_N, 2.0 * SomeCovariance_N2()));
    }
    held += is_expected(as_it_is) ? 1 : 0;
    EXPECT_GT(halved.NeesPerDegree(), halved.HighestExpected());
    EXPECT_LT(doubled.NeesPerDegree(), doubled.LowestExpected());
  }
  EXPECT_GE(held, 35);
}

}  // namespace
}  // namespace palpate::force_estimation
