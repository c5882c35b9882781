// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/surface_matching.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/components/force_estimation/shape_scene.hpp"

namespace palpate::force_estimation {
namespace {

int CountOf(const std::vector<correspondence::FeatureMatch>& matches,
            correspondence::MatchState state) {
  return static_cast<int>(std::count_if(matches.begin(), matches.end(),
                                        [&](const auto& match) { return match.state == state; }));
}

ShapeConfig WithMatching(const std::string& matching) {
  ShapeConfig config;
  config.matching = matching;
  return config;
}

TEST(PatchMatching, ExactCloudOfABentBodyHasNoResidual) {
  const ShapeScene& scene = FourLegScene();
  const Eigen::VectorXd x_m = Moved(scene.rest_x_m, Bend);
  SurfaceMatching matching(*scene.features, WithMatching("patch"));
  const auto& matches = matching.Match(FrameOf(Cast(scene, x_m, BenchPose())), x_m);
  EXPECT_GE(CountOf(matches, correspondence::MatchState::kMatched), 20);
  EXPECT_EQ(CountOf(matches, correspondence::MatchState::kOutlier), 0);
  for (const correspondence::FeatureMatch& match : matches) {
    if (match.state != correspondence::MatchState::kMatched) continue;
    EXPECT_NEAR(Residual_m(match, x_m), 0.0, 1e-5);
  }
}

TEST(PatchMatching, ARowNamesItsNodesRisingAndMovesWithTheBody) {
  const ShapeScene& scene = FourLegScene();
  SurfaceMatching matching(*scene.features, WithMatching("patch"));
  const auto& matches =
      matching.Match(FrameOf(Cast(scene, scene.rest_x_m, BenchPose())), scene.rest_x_m);
  for (const correspondence::FeatureMatch& match : matches) {
    if (match.state != correspondence::MatchState::kMatched) continue;
    ASSERT_EQ(match.row.nodes.size(), match.row.coefficients.size());
    EXPECT_TRUE(
        std::is_sorted(match.row.nodes.begin(), match.row.nodes.end(), std::less_equal<>()));
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& coefficient : match.row.coefficients) sum += coefficient;
    EXPECT_TRUE(sum.isApprox(match.normal, 1e-9));
    EXPECT_LE(match.normal.norm(), 1.0 + 1e-12);
    EXPECT_GT(match.normal.norm(), 0.5);
  }
}

/// A cloud of the body `by_m` away from where the model is.
void ExpectShiftAlongNormals(const Eigen::Vector3d& by_m, double tolerance_m) {
  const ShapeScene& scene = FourLegScene();
  SurfaceMatching matching(*scene.features, WithMatching("patch"));
  const Eigen::VectorXd shifted_m = Shifted(scene.rest_x_m, by_m);
  const auto& matches =
      matching.Match(FrameOf(Cast(scene, shifted_m, BenchPose())), scene.rest_x_m);
  EXPECT_GE(CountOf(matches, correspondence::MatchState::kMatched), 20);
  for (const correspondence::FeatureMatch& match : matches) {
    if (match.state != correspondence::MatchState::kMatched) continue;
    EXPECT_NEAR(Residual_m(match, scene.rest_x_m), match.normal.dot(by_m), tolerance_m)
        << match.count << " points, normal " << match.normal.transpose();
  }
}

TEST(PatchMatching, AShiftTowardsTheCameraIsFoundAlongTheNormals) {
  ExpectShiftAlongNormals(1e-3 * (BenchPose().linear() * Eigen::Vector3d(0, 0, -1)), 2e-5);
}

/// The surface turns away from its shifted self by up to shift / radius: second order.
TEST(PatchMatching, AShiftAcrossTheViewIsFoundAlongTheNormals) {
  ExpectShiftAlongNormals(5e-4 * (BenchPose().linear() * Eigen::Vector3d(0.6, 0.8, 0)), 3e-5);
}

/// Rigid motion of robot, cloud and camera together: a change of the robot frame.
TEST(SurfaceMatching, DoesNotDependOnTheRobotFrame) {
  const ShapeScene& scene = FourLegScene();
  const ShapeFrame frame = FrameOf(Cast(scene, Moved(scene.rest_x_m, Bend), BenchPose()));
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.rotate(Eigen::AngleAxisd(1.1, Eigen::Vector3d(2, -1, 2) / 3.0));
  motion.translation() = Eigen::Vector3d(0.3, -0.7, 0.2);
  ShapeFrame moved = frame;
  moved.views[0].T_robot_camera = motion * frame.views[0].T_robot_camera;
  const Eigen::VectorXd moved_x_m = Moved(scene.rest_x_m, [&](const Eigen::Vector3d& rest_m) {
    return Eigen::Vector3d(motion * rest_m - rest_m);
  });
  for (const char* way : {"patch", "point"}) {
    SurfaceMatching matching(*scene.features, WithMatching(way));
    const std::vector<correspondence::FeatureMatch> here = matching.Match(frame, scene.rest_x_m);
    const std::vector<correspondence::FeatureMatch> there = matching.Match(moved, moved_x_m);
    for (size_t k = 0; k < here.size(); ++k) {
      ASSERT_EQ(here[k].state, there[k].state);
      EXPECT_NEAR(Residual_m(here[k], scene.rest_x_m), Residual_m(there[k], moved_x_m), 1e-8);
      EXPECT_NEAR(here[k].sigma_m, there[k].sigma_m, 1e-9);
      EXPECT_LT((motion.linear() * here[k].normal - there[k].normal).norm(), 1e-5);
      EXPECT_LT((here[k].position_m - there[k].position_m).norm(), 1e-6);
      EXPECT_EQ(here[k].row.nodes, there[k].row.nodes);
    }
  }
}

TEST(SurfaceMatching, RemembersNothingOfTheFrameBefore) {
  const ShapeScene& scene = FourLegScene();
  const ShapeFrame frame = FrameOf(Cast(scene, Moved(scene.rest_x_m, Bend), BenchPose()));
  for (const char* way : {"patch", "point"}) {
    SurfaceMatching used(*scene.features, WithMatching(way));
    const Eigen::Isometry3d elsewhere = LookAt({-0.2, 0.3, 0.1}, {0.0, 0.0, 0.05});
    used.Match(FrameOf(Cast(scene, scene.rest_x_m, elsewhere), elsewhere), scene.rest_x_m);
    SurfaceMatching fresh(*scene.features, WithMatching(way));
    const auto& again = used.Match(frame, scene.rest_x_m);
    const auto& once = fresh.Match(frame, scene.rest_x_m);
    for (size_t k = 0; k < once.size(); ++k) {
      EXPECT_EQ(again[k].state, once[k].state);
      EXPECT_EQ(again[k].target_m, once[k].target_m);
      EXPECT_EQ(again[k].sigma_m, once[k].sigma_m);
      EXPECT_EQ(again[k].row.coefficients, once[k].row.coefficients);
    }
  }
}

/// The model moves by a little under a cloud that lies 0.3 mm off: what the rows say happens.
TEST(PatchMatching, RowsAreTheDerivativeOfTheMatchedDistance) {
  const ShapeScene& scene = FourLegScene();
  SurfaceMatching matching(*scene.features, WithMatching("patch"));
  const Eigen::Vector3d towards = BenchPose().linear() * Eigen::Vector3d(0.2, 0.1, -1.0);
  const ShapeFrame frame =
      FrameOf(Cast(scene, Shifted(scene.rest_x_m, 3e-4 * towards), BenchPose()));
  constexpr double kStep = 0.02;  // of Bend: some 0.1 mm
  const auto bend = [&](const Eigen::Vector3d& rest_m) {
    return Eigen::Vector3d(kStep * Bend(rest_m));
  };
  const Eigen::VectorXd bent_m = Moved(scene.rest_x_m, bend);
  const std::vector<correspondence::FeatureMatch> before = matching.Match(frame, scene.rest_x_m);
  const std::vector<correspondence::FeatureMatch> after = matching.Match(frame, bent_m);
  double largest_m = 0.0;
  for (size_t k = 0; k < before.size(); ++k) {
    if (before[k].state != correspondence::MatchState::kMatched || before[k].count < 30) continue;
    const double by_row_m = -before[k].row.Value(bent_m - scene.rest_x_m);
    const double found_m = Residual_m(after[k], bent_m) - Residual_m(before[k], scene.rest_x_m);
    EXPECT_NEAR(found_m, by_row_m, 2e-6) << before[k].count;
    largest_m = std::max(largest_m, std::abs(by_row_m));
  }
  EXPECT_GT(largest_m, 6e-5);
}

TEST(PatchMatching, ResidualsScatterAsTheirSigmasSay) {
  const ShapeScene& scene = FourLegScene();
  SurfaceMatching matching(*scene.features, WithMatching("patch"));
  const rgbd::SensedCloud exact = Cast(scene, scene.rest_x_m, BenchPose());
  std::mt19937 random(11);
  constexpr int kSeeds = 60;
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(scene.features->Count());
  Eigen::ArrayXd squares = sum;
  Eigen::ArrayXd count = sum;
  for (int seed = 0; seed < kSeeds; ++seed) {
    ShapeFrame frame = FrameOf(exact);
    AddDepthNoise(random, &frame.views[0].cloud);
    const auto& matches = matching.Match(frame, scene.rest_x_m);
    for (int k = 0; k < scene.features->Count(); ++k) {
      const correspondence::FeatureMatch& match = matches[static_cast<size_t>(k)];
      if (match.state != correspondence::MatchState::kMatched || match.count < 10) continue;
      const double share = Residual_m(match, scene.rest_x_m) / match.sigma_m;
      sum[k] += share;
      squares[k] += share * share;
      count[k] += 1.0;
    }
  }
  int features = 0;
  double mean_variance = 0.0;
  for (int k = 0; k < scene.features->Count(); ++k) {
    if (count[k] < kSeeds) continue;
    const double variance = squares[k] / kSeeds - std::pow(sum[k] / kSeeds, 2);
    EXPECT_NEAR(std::sqrt(variance), 1.0, 0.35) << k;  // 60 seeds: 9 % sigma
    EXPECT_LT(std::abs(sum[k]) / kSeeds, 1.0) << k;    // no bias beyond the noise of one frame
    mean_variance += variance;
    ++features;
  }
  ASSERT_GE(features, 20);
  EXPECT_NEAR(std::sqrt(mean_variance / features), 1.0, 0.1);
}

/// A tool before the middle of a feature's share, `off_m` towards the camera: every `nth` point of
/// the share's.
rgbd::SensedCloud WithTool(rgbd::SensedCloud cloud, const Eigen::Vector3d& centre_m,
                           double radius_m, float off_m, int nth) {
  int seen = 0;
  for (Eigen::Index k = 0; k < cloud.Count(); ++k) {
    const Eigen::Vector3d from_m = cloud.points_m.col(k).cast<double>() - centre_m;
    if (from_m.norm() > radius_m || seen++ % nth != 0) continue;
    cloud.points_m.col(k) *= 1.0f - off_m / cloud.points_m(2, k);
  }
  return cloud;
}

/// The feature that most points stand behind.
int BestSeen(const std::vector<correspondence::FeatureMatch>& matches) {
  const auto best =
      std::max_element(matches.begin(), matches.end(),
                       [](const auto& a, const auto& b) { return a.count < b.count; });
  return static_cast<int>(best - matches.begin());
}

TEST(PatchMatching, WhatLiesFarBeforeTheSurfaceIsLeftOutAndCounted) {
  const ShapeScene& scene = FourLegScene();
  SurfaceMatching matching(*scene.features, WithMatching("patch"));
  const rgbd::SensedCloud clean = Cast(scene, scene.rest_x_m, BenchPose());
  const std::vector<correspondence::FeatureMatch> matches =
      matching.Match(FrameOf(clean), scene.rest_x_m);
  const auto best = static_cast<size_t>(BestSeen(matches));
  EXPECT_EQ(matches[best].outliers, 0);
  const Eigen::Vector3d centre_m = matches[best].position_m;
  const correspondence::FeatureMatch half =
      matching.Match(FrameOf(WithTool(clean, centre_m, 0.02, 0.02f, 3)), scene.rest_x_m)[best];
  EXPECT_EQ(half.state, correspondence::MatchState::kMatched);
  EXPECT_GE(half.outliers, matches[best].count / 5);
  EXPECT_NEAR(Residual_m(half, scene.rest_x_m), 0.0, 2e-5);
  const correspondence::FeatureMatch all =
      matching.Match(FrameOf(WithTool(clean, centre_m, 0.05, 0.025f, 1)), scene.rest_x_m)[best];
  EXPECT_EQ(all.state, correspondence::MatchState::kOutlier);
  EXPECT_NEAR(all.distance_m, 0.02, 6e-3);
}

TEST(PatchMatching, AFewWrongPointsNearTheSurfaceDoNotMoveTheMean) {
  const ShapeScene& scene = FourLegScene();
  SurfaceMatching matching(*scene.features, WithMatching("patch"));
  rgbd::SensedCloud cloud = Cast(scene, scene.rest_x_m, BenchPose());
  std::mt19937 random(8);
  AddDepthNoise(random, &cloud);
  const std::vector<correspondence::FeatureMatch> clean =
      matching.Match(FrameOf(cloud), scene.rest_x_m);
  const auto best = static_cast<size_t>(BestSeen(clean));
  const correspondence::FeatureMatch touched = matching.Match(
      FrameOf(WithTool(cloud, clean[best].position_m, 0.03, 0.006f, 4)), scene.rest_x_m)[best];
  EXPECT_EQ(touched.outliers, 0);
  EXPECT_NEAR(Residual_m(touched, scene.rest_x_m), Residual_m(clean[best], scene.rest_x_m),
              2.0 * clean[best].sigma_m);
}

TEST(SurfaceMatching, TheOutlierDistanceIsASetting) {
  const ShapeScene& scene = FourLegScene();
  for (const char* way : {"patch", "point"}) {
    ShapeConfig config = WithMatching(way);
    config.outlier_distance_m = 1e-3;
    SurfaceMatching matching(*scene.features, config);
    const Eigen::VectorXd away_m =
        Shifted(scene.rest_x_m, BenchPose().linear() * Eigen::Vector3d(0, 0, 6e-3));
    const auto& matches = matching.Match(FrameOf(Cast(scene, scene.rest_x_m, BenchPose())), away_m);
    EXPECT_GE(CountOf(matches, correspondence::MatchState::kOutlier), 10) << way;
    for (const correspondence::FeatureMatch& match : matches) {
      if (match.state == correspondence::MatchState::kHidden) continue;
      EXPECT_EQ(match.distance_m > 1e-3, match.state == correspondence::MatchState::kOutlier);
    }
  }
}

}  // namespace
}  // namespace palpate::force_estimation
