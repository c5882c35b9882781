// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/live/marker_means.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

namespace palpate::calibration {
namespace {

constexpr double kAlong_m = 1.5e-3, kAcross_m = 2e-4;

/// Known well across the line of sight and badly along it.
Eigen::Matrix3d DepthNoise(const Eigen::Vector3d& position_m) {
  const Eigen::Vector3d ray = position_m.normalized();
  return kAcross_m * kAcross_m * Eigen::Matrix3d::Identity() +
         (kAlong_m * kAlong_m - kAcross_m * kAcross_m) * ray * ray.transpose();
}

/// Six pictures of two markers, the second of which trembles more than it says where `noise_factor`
/// is 1.
std::vector<SeenMarkers> Pictures(double noise_factor = 1.0) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise;
  std::vector<SeenMarkers> pictures(6);
  for (SeenMarkers& picture : pictures) {
    for (int m = 0; m < 2; ++m) {
      const Eigen::Vector3d place_m(0.2 * m - 0.1, 0.15, 0.4 + 0.1 * m);
      const Eigen::Matrix3d covariance_m2 = DepthNoise(place_m);
      const Eigen::Matrix3d root = Eigen::LLT<Eigen::Matrix3d>(covariance_m2).matrixL();
      const Eigen::Vector3d draw(noise(random), noise(random), noise(random));
      picture.markers.push_back(
          {.marker = m,
           .position_m = place_m + noise_factor * (0.4 + 1.2 * m) * root * draw,
           .covariance_m2 = covariance_m2});
    }
  }
  return pictures;
}

TEST(MarkerMeans, AFrameThatIsTurnedTurnsThePlacesAndTheirCovariances) {
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(0.3, -0.8, 0.5).normalized()).toRotationMatrix();
  std::vector<SeenMarkers> turned = Pictures();
  for (SeenMarkers& picture : turned) {
    for (MarkerSighting& marker : picture.markers) {
      marker.position_m = R * marker.position_m;
      marker.covariance_m2 = R * marker.covariance_m2 * R.transpose();
    }
  }
  const auto means = MeanMarkers(Pictures(), 1e-4), after = MeanMarkers(turned, 1e-4);
  ASSERT_EQ(means.size(), 2u);
  for (std::size_t m = 0; m < 2; ++m) {
    EXPECT_TRUE(after[m].position_m.isApprox(R * means[m].position_m, 1e-12));
    EXPECT_TRUE(after[m].covariance_m2.isApprox(R * means[m].covariance_m2 * R.transpose(), 1e-9));
  }
  // What the first one varies by is less than it says, the second one's is not.
  const Eigen::Matrix3d said_m2 = DepthNoise({-0.1, 0.15, 0.4}) / 6.0;
  const Eigen::Matrix3d bias_m2 = 1e-8 * Eigen::Matrix3d::Identity();
  EXPECT_TRUE((means[0].covariance_m2 - bias_m2).isApprox(said_m2, 1e-9));
  EXPECT_GT(means[1].covariance_m2.trace(), 1.5 * DepthNoise({0.1, 0.15, 0.5}).trace() / 6.0);
}

TEST(MarkerMeans, PointsWithoutNamesAreAveragedWithTheNearestWhateverTheirOrder) {
  std::vector<SeenMarkers> pictures = Pictures(0.2);
  const auto named = MeanMarkers(pictures, 0.0);
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    auto& markers = pictures[k].markers;
    for (MarkerSighting& marker : markers) marker.marker = -1;
    if (k % 2 == 1) std::swap(markers[0], markers[1]);
  }
  EXPECT_FALSE(HaveNames(pictures[0].markers));
  pictures.push_back({0, {pictures[0].markers[1]}});  // one of them alone
  pictures.back().markers[0].position_m = named[1].position_m;
  const auto means = MeanMarkers(pictures, 0.0);
  ASSERT_EQ(means.size(), 2u);
  for (std::size_t m = 0; m < 2; ++m) {
    EXPECT_EQ(means[m].marker, -1);
    EXPECT_TRUE(means[m].position_m.isApprox(named[m].position_m, 1e-12));
  }
  EXPECT_TRUE(means[0].covariance_m2.isApprox(named[0].covariance_m2, 1e-9));
  EXPECT_LT(means[1].covariance_m2.trace(), named[1].covariance_m2.trace()) << "of seven";
}

TEST(MarkerMeans, AmongNamesPointsWithoutOneAreLeftOut) {
  std::vector<SeenMarkers> pictures = Pictures();
  for (SeenMarkers& picture : pictures) picture.markers[0].marker = -1;
  const auto means = MeanMarkers(pictures, 0.0);
  ASSERT_EQ(means.size(), 1u);
  EXPECT_EQ(means[0].marker, 1);
}

}  // namespace
}  // namespace palpate::calibration
