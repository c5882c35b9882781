// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "components/force_estimation/shape/depth_bias.hpp"
#include "tests/components/force_estimation/shape_scene.hpp"

namespace palpate::force_estimation {
namespace {

constexpr double kDistance_m = 0.45;

/// What the calibration of a camera that is held to be at `pose` found, and erred by: a depth that
/// is too short by a share as a camera that is too far by as much, and a little of everything.
struct Found {
  geometry::DepthBiasMap map;
  Eigen::VectorXd error;  ///< found - true: pose (6), coefficients (6)
};

Found FindWithErrors(const Eigen::Isometry3d& pose, std::mt19937& random) {
  std::normal_distribution<double> normal(0.0, 1.0);
  Eigen::MatrixXd root(12, 13);
  for (double& entry : root.reshaped()) entry = 2e-5 * normal(random);
  root.col(12).setZero();
  root.col(12).segment<3>(3) = 3e-3 * kDistance_m * pose.linear().col(2);
  root(6, 12) = -3e-3;
  Eigen::VectorXd draws(13);
  for (double& draw : draws) draw = normal(random);
  Found found;
  found.map.covariance = root * root.transpose();
  found.error = root * draws;
  found.map.coefficients.resize(6);
  for (double& coefficient : found.map.coefficients) coefficient = 3e-3 * normal(random);
  return found;
}

correspondence::FeatureMatch MatchAt(const Eigen::Vector3d& position_m,
                                     const Eigen::Vector3d& normal) {
  correspondence::FeatureMatch match;
  match.state = correspondence::MatchState::kMatched;
  match.sigma_m = 1e-5;
  match.position_m = position_m;
  match.normal = normal.normalized();
  return match;
}

/// Without a single frame: the targets' errors are what the file's covariance says of them.
TEST(DepthBiasFromCalibration, ErrsAsTheCalibrationDid) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Eigen::Isometry3d pose = BenchPose();
  constexpr int kDraws = 400;
  double sum = 0.0, sigma_m = 0.0;
  for (int k = 0; k < kDraws; ++k) {
    const Found found = FindWithErrors(pose, random);
    ShapeConfig config;
    config.feature_offset_prior_m = 1e-9;
    DepthBias bias(1, config);
    bias.StartFrom(found.map, pose);
    EXPECT_TRUE(bias.known());
    EXPECT_TRUE(bias.Finish().ok());
    const correspondence::FeatureMatch match =
        MatchAt({0.1 * uniform(random), 0.1 * uniform(random), kDistance_m},
                {uniform(random), uniform(random), uniform(random)});
    const Eigen::Vector3d here_m = pose.linear() * match.position_m;
    geometry::DepthBiasMap truth = found.map;
    truth.coefficients -= found.error.tail<6>();
    // Where the found pose without a map has the point, against where it is.
    const Eigen::Vector3d shift_m = Eigen::Vector3d(found.error.head<3>()).cross(here_m) +
                                    found.error.segment<3>(3) - truth.At(match.position_m) * here_m;
    const double error_m = match.normal.dot(shift_m) - bias.Correction_m(0, match, pose);
    sigma_m = bias.CorrectionSigma_m(0, match, pose);
    sum += error_m * error_m / (sigma_m * sigma_m);
    EXPECT_LT(sigma_m, 5e-4);  // a share of 3e-3 alone would be 1.35 mm
  }
  EXPECT_NEAR(sum / kDraws, 1.0, 0.2);
}

/// The frames may be those that it was calibrated with. One that tells as much as it does leaves it
/// as sure as it was; two independent ones would halve the variance.
TEST(DepthBiasFromCalibration, IsNoSurerAfterAFrameItMayHaveComeFrom) {
  std::mt19937 random(3);
  const Eigen::Isometry3d pose = BenchPose();
  const Found found = FindWithErrors(pose, random);
  ShapeConfig config;
  config.feature_offset_prior_m = 1e-9;
  DepthBias bias(1, config);
  bias.StartFrom(found.map, pose);
  ASSERT_TRUE(bias.Finish().ok());
  correspondence::FeatureMatch match = MatchAt({0.05, -0.03, kDistance_m}, {0.2, -0.1, -1.0});
  const double before_m = bias.CorrectionSigma_m(0, match, pose);
  match.sigma_m = before_m;
  match.target_m = bias.Correction_m(0, match, pose);
  bias.Learn(std::vector{match}, Eigen::VectorXd(), pose);
  ASSERT_TRUE(bias.Finish().ok());
  EXPECT_NEAR(bias.CorrectionSigma_m(0, match, pose) / before_m, 1.0, 1e-6);
}

TEST(DepthBiasFromCalibration, IsLearntOn) {
  geometry::DepthBiasMap map;
  map.coefficients = -4e-3 * Eigen::VectorXd::Unit(6, 0);
  map.covariance = 1e-6 * Eigen::MatrixXd::Identity(12, 12);
  geometry::DepthBiasMap truth = map;
  truth.coefficients << -5e-3, 5e-4, -5e-4, 0.0, 5e-4, 0.0;
  const Eigen::Isometry3d pose = BenchPose();
  std::vector<correspondence::FeatureMatch> matches;
  for (int k = 0; k < 30; ++k) {
    const Eigen::Vector3d position_m(0.1 * std::cos(k), 0.1 * std::sin(1.7 * k), kDistance_m);
    const Eigen::Vector3d normal(std::sin(2.0 * k), std::cos(3.0 * k), -1.5);
    matches.push_back(MatchAt(position_m, pose.linear() * normal));
    matches.back().target_m =
        -truth.At(position_m) * matches.back().normal.dot(pose.linear() * position_m);
  }
  DepthBias bias(30, {});
  bias.StartFrom(map, pose);
  const auto largest_m = [&] {
    double largest = 0.0;
    for (int k = 0; k < 30; ++k) {
      const correspondence::FeatureMatch& match = matches[static_cast<std::size_t>(k)];
      largest = std::max(largest, std::abs(match.target_m - bias.Correction_m(k, match, pose)));
    }
    return largest;
  };
  const double from_file_m = largest_m();
  EXPECT_GT(from_file_m, 3e-4);
  EXPECT_LT(from_file_m, 1e-3);
  for (int frame = 0; frame < 10; ++frame) bias.Learn(matches, Eigen::VectorXd::Zero(3), pose);
  ASSERT_TRUE(bias.Finish().ok());
  EXPECT_LT(largest_m(), 0.02 * from_file_m);
}

}  // namespace
}  // namespace palpate::force_estimation
