// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/depth_bias.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/components/force_estimation/shape_scene.hpp"

namespace palpate::force_estimation {
namespace {

/// The camera is 1 mm and 2 mrad off its assumed pose.
Eigen::Isometry3d TruePose() {
  Eigen::Isometry3d error = Eigen::Isometry3d::Identity();
  error.rotate(Eigen::AngleAxisd(2e-3, Eigen::Vector3d(1, -2, 2) / 3.0));
  error.translation() = Eigen::Vector3d(0.6, -0.48, 0.64) * 1e-3;
  return BenchPose() * error;
}

/// 0.5 % of z, smooth over the image.
void AddDepthBias(rgbd::SensedCloud* cloud) {
  for (Eigen::Index k = 0; k < cloud->Count(); ++k) {
    const Eigen::Vector3f point_m = cloud->points_m.col(k);
    const float x = point_m.x() / point_m.z();
    const float y = point_m.y() / point_m.z();
    cloud->points_m.col(k) *= 1.0f + 5e-3f * std::cos(2.0f * x - 3.0f * y);
  }
}

/// What the camera of TruePose sees of the robot at `x_m`.
rgbd::SensedCloud BiasedCloud(const Eigen::VectorXd& x_m) {
  rgbd::SensedCloud cloud = Cast(FourLegScene(), x_m, TruePose());
  AddDepthBias(&cloud);
  return cloud;
}

ShapeFrame NoisyFrame(const rgbd::SensedCloud& cloud, std::mt19937& random) {
  ShapeFrame frame = FrameOf(cloud);
  AddDepthNoise(random, &frame.views[0].cloud);
  return frame;
}

/// From 30 frames of the robot at rest.
DepthBias LearntBias(SurfaceMatching* matching) {
  const ShapeScene& scene = FourLegScene();
  DepthBias bias(scene.features->Count(), {});
  std::mt19937 random(5);
  const rgbd::SensedCloud cloud = BiasedCloud(scene.rest_x_m);
  for (int frame = 0; frame < 30; ++frame) {
    bias.Learn(matching->Match(NoisyFrame(cloud, random), scene.rest_x_m), scene.rest_x_m,
               BenchPose());
  }
  const Status status = bias.Finish();
  EXPECT_TRUE(status.ok()) << status.message();
  return bias;
}

/// Root mean square over frames and features of what is left of the residuals, m; `mean_m` likewise
/// of each feature's mean over the frames.
struct Left {
  double single_m = 0.0;
  double mean_m = 0.0;
  double share_of_sigma = 0.0;  ///< of single residuals in what is expected of them
};

Left LeftOver(const Eigen::VectorXd& x_m, const DepthBias& bias, SurfaceMatching* matching) {
  constexpr int kFrames = 10;
  const int features = FourLegScene().features->Count();
  std::mt19937 random(77);
  const rgbd::SensedCloud cloud = BiasedCloud(x_m);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(features);
  Left left;
  int count = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    const auto& matches = matching->Match(NoisyFrame(cloud, random), x_m);
    for (int feature = 0; feature < features; ++feature) {
      const correspondence::FeatureMatch& match = matches[static_cast<size_t>(feature)];
      if (match.state != correspondence::MatchState::kMatched) continue;
      const double error_m =
          Residual_m(match, x_m) - bias.Correction_m(feature, match, BenchPose());
      const double sigma_m =
          std::hypot(match.sigma_m, bias.CorrectionSigma_m(feature, match, BenchPose()));
      sum[feature] += error_m / kFrames;
      left.single_m += error_m * error_m;
      left.share_of_sigma += error_m * error_m / (sigma_m * sigma_m);
      ++count;
    }
  }
  left.single_m = std::sqrt(left.single_m / count);
  left.share_of_sigma = std::sqrt(left.share_of_sigma / count);
  left.mean_m = std::sqrt(sum.squaredNorm() / (count / kFrames));
  return left;
}

TEST(DepthBias, TakesOutASmoothBiasAndAPoseErrorOfNewFrames) {
  const ShapeScene& scene = FourLegScene();
  SurfaceMatching matching(*scene.features, {});
  const Left before = LeftOver(scene.rest_x_m, DepthBias(scene.features->Count(), {}), &matching);
  EXPECT_GT(before.mean_m, 5e-4);
  const DepthBias bias = LearntBias(&matching);
  const Left at_rest = LeftOver(scene.rest_x_m, bias, &matching);
  EXPECT_LT(at_rest.mean_m, 4e-5);
  EXPECT_LT(at_rest.single_m, 1e-4);
  const Left bent = LeftOver(Moved(scene.rest_x_m, Bend), bias, &matching);
  EXPECT_LT(bent.mean_m, 5e-5);
  for (const double share : {at_rest.share_of_sigma, bent.share_of_sigma}) {
    EXPECT_NEAR(share, 1.0, 0.15);
  }
}

TEST(DepthBias, KnowsNothingBeforeItHasLearnt) {
  const ShapeScene& scene = FourLegScene();
  SurfaceMatching matching(*scene.features, {});
  const auto& matches = matching.Match(FrameOf(BiasedCloud(scene.rest_x_m)), scene.rest_x_m);
  DepthBias bias(scene.features->Count(), {});
  EXPECT_FALSE(bias.known());
  EXPECT_EQ(bias.frames(), 0);
  EXPECT_EQ(bias.NoiseScale(), 1.0);
  for (int feature = 0; feature < scene.features->Count(); ++feature) {
    const correspondence::FeatureMatch& match = matches[static_cast<size_t>(feature)];
    EXPECT_EQ(bias.Correction_m(feature, match, BenchPose()), 0.0);
    if (match.state != correspondence::MatchState::kMatched) continue;
    // The camera's place alone is known to 2 mm, a depth to 0.5 %.
    EXPECT_GT(bias.CorrectionSigma_m(feature, match, BenchPose()), 1e-3);
    EXPECT_LT(bias.CorrectionSigma_m(feature, match, BenchPose()), 5e-3);
  }
}

TEST(DepthBias, NeedsThreeFeatures) {
  DepthBias bias(4, {});
  EXPECT_EQ(bias.Finish().code(), StatusCode::kNoCalibration);
  correspondence::FeatureMatch match;
  match.state = correspondence::MatchState::kMatched;
  match.sigma_m = 1e-4;
  match.normal = Eigen::Vector3d::UnitX();
  match.position_m = {0.0, 0.0, 0.4};
  const Eigen::VectorXd x_m = Eigen::VectorXd::Zero(3);
  const correspondence::FeatureMatch hidden;
  bias.Learn(std::vector{hidden, hidden, hidden, hidden}, x_m, BenchPose());
  EXPECT_EQ(bias.frames(), 0);
  bias.Learn(std::vector{match, hidden, match, hidden}, x_m, BenchPose());
  EXPECT_EQ(bias.Finish().code(), StatusCode::kNoCalibration);
  EXPECT_FALSE(bias.known());
  bias.Learn(std::vector{match, hidden, match, match}, x_m, BenchPose());
  EXPECT_TRUE(bias.Finish().ok());
  EXPECT_TRUE(bias.known());
  EXPECT_EQ(bias.frames(), 2);
}

/// 12 features all around, each with an offset of its own and noise of which the next frame
/// remembers a share. The matches say 0.1 mm.
struct NoiseLesson {
  static constexpr int kFeatures = 12;

  void Learn(double sigma_m, double memory, int frames, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0.0, 1.0);
    for (size_t k = 0; k < kFeatures; ++k) {
      const double angle = 0.5 * static_cast<double>(k);
      matches[k].state = correspondence::MatchState::kMatched;
      matches[k].sigma_m = 1e-4;
      matches[k].normal = -Eigen::Vector3d(0.4 * std::cos(angle), 0.4 * std::sin(angle), 0.9);
      matches[k].position_m = {0.05 * std::cos(angle), 0.05 * std::sin(angle), 0.45};
      offset_m[k] = 3e-4 * normal(random);
      noise_m[k] = sigma_m * normal(random);
    }
    const double fresh = std::sqrt(1.0 - memory * memory);
    for (int frame = 0; frame < frames; ++frame) {
      for (size_t k = 0; k < kFeatures; ++k) {
        matches[k].target_m = offset_m[k] + noise_m[k];
        noise_m[k] = memory * noise_m[k] + fresh * sigma_m * normal(random);
      }
      bias.Learn(matches, Eigen::VectorXd::Zero(3), Eigen::Isometry3d::Identity());
    }
    EXPECT_TRUE(bias.Finish().ok());
  }

  DepthBias bias{kFeatures, {}};
  std::vector<correspondence::FeatureMatch> matches{kFeatures};
  std::vector<double> offset_m = std::vector<double>(kFeatures);
  std::vector<double> noise_m = std::vector<double>(kFeatures);
};

TEST(DepthBias, NoiseScaleIsTheScatterOfTheFramesOverWhatTheySay) {
  for (const double scale : {0.5, 1.0, 2.0}) {
    for (const double memory : {0.0, 0.5}) {
      NoiseLesson lesson;
      lesson.Learn(scale * 1e-4, memory, 60, 3);
      EXPECT_NEAR(lesson.bias.NoiseScale(), scale, 0.1 * scale) << memory;
    }
  }
}

/// A mean takes with it what the frames err alike.
TEST(DepthBias, NoiseScaleHoldsForFewCorrelatedFrames) {
  double sum = 0.0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    NoiseLesson lesson;
    lesson.Learn(1e-4, 0.5, 20, 200 + seed);
    sum += lesson.bias.NoiseScale();
  }
  EXPECT_NEAR(sum / 60, 1.0, 0.04);
}

struct Errors {
  double scale;
  double memory;
};

TEST(DepthBias, IsAsWrongAsItSaysWhetherFramesErrAlikeOrNot) {
  for (const auto& [scale, memory] :
       {Errors{1.0, 0.0}, Errors{1.0, 0.3}, Errors{1.0, 0.6}, Errors{2.0, 0.3}, Errors{0.5, 0.0}}) {
    double sum = 0.0;
    int count = 0;
    for (unsigned seed = 0; seed < 50; ++seed) {
      NoiseLesson lesson;
      lesson.Learn(scale * 1e-4, memory, 30, 100 + seed);
      for (int k = 0; k < NoiseLesson::kFeatures; ++k) {
        const auto at = static_cast<size_t>(k);
        const Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        const double error_m =
            lesson.bias.Correction_m(k, lesson.matches[at], pose) - lesson.offset_m[at];
        const double sigma_m = lesson.bias.CorrectionSigma_m(k, lesson.matches[at], pose);
        sum += error_m * error_m / (sigma_m * sigma_m);
        ++count;
      }
    }
    EXPECT_NEAR(std::sqrt(sum / count), 1.0, 0.15) << scale << ' ' << memory;
  }
}

/// Sequences in other postures, each of which adds errors of its own to the points' offsets.
struct PostureLesson {
  static constexpr std::size_t kFeatures = 40;

  /// Learns `postures` of two frames each. Returns the mean square, over its variance, of the error
  /// of the correction in one more posture.
  double Learn(double posture_m, int postures, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0.0, 1.0);
    std::vector<correspondence::FeatureMatch> matches(kFeatures);
    std::vector<double> offset_m(kFeatures);
    for (std::size_t k = 0; k < kFeatures; ++k) {
      const double angle = 0.5 * static_cast<double>(k);
      matches[k].state = correspondence::MatchState::kMatched;
      matches[k].sigma_m = 3e-5;
      matches[k].normal = -Eigen::Vector3d(0.4 * std::cos(angle), 0.4 * std::sin(angle), 0.9);
      matches[k].position_m = {0.05 * std::cos(angle), 0.05 * std::sin(angle), 0.45};
      offset_m[k] = 3e-4 * normal(random);
    }
    DepthBias bias(kFeatures, {});
    const Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    const Eigen::VectorXd x_m = Eigen::VectorXd::Zero(3);
    for (int posture = 0; posture < postures; ++posture) {
      std::vector<double> here_m = offset_m;
      for (double& one_m : here_m) one_m += posture_m * normal(random);
      for (int frame = 0; frame < 2; ++frame) {
        for (std::size_t k = 0; k < kFeatures; ++k) {
          matches[k].target_m = here_m[k] + matches[k].sigma_m * normal(random);
        }
        bias.Learn(matches, x_m, pose, static_cast<std::uint32_t>(posture));
      }
    }
    EXPECT_TRUE(bias.Finish().ok());
    noise_scale = bias.NoiseScale();
    double sum = 0.0;
    for (std::size_t k = 0; k < kFeatures; ++k) {
      const int feature = static_cast<int>(k);
      const double error_m =
          bias.Correction_m(feature, matches[k], pose) - offset_m[k] - posture_m * normal(random);
      sigma_m = bias.CorrectionSigma_m(feature, matches[k], pose);
      sum += error_m * error_m / (sigma_m * sigma_m);
    }
    return sum / kFeatures;
  }

  double noise_scale = 0.0, sigma_m = 0.0;
};

TEST(DepthBias, IsAsWrongAsItSaysInAPostureThatIsToCome) {
  for (const double posture_m : {5e-5, 1e-4, 2e-4}) {
    double sum = 0.0;
    for (unsigned seed = 0; seed < 30; ++seed) {
      PostureLesson lesson;
      sum += lesson.Learn(posture_m, 3, 500 + seed);
      EXPECT_NEAR(lesson.noise_scale, 1.0, 0.25) << "what postures differ by is no noise";
    }
    EXPECT_NEAR(std::sqrt(sum / 30), 1.0, 0.2) << posture_m;
  }
}

TEST(DepthBias, PosturesThatAgreeTellMoreThanOne) {
  PostureLesson one, four;
  one.Learn(0.0, 1, 9);
  four.Learn(0.0, 4, 9);
  EXPECT_LT(four.sigma_m, one.sigma_m);
}

/// The effect of a bias on surface points all over the image is estimated from every other one and
/// predicted for the rest. `bias_m`: change of a cloud point (camera frame) at a position.
template <typename Bias>
void ExpectToldFromHalf(const ShapeConfig& config, const Bias& bias_m) {
  constexpr int kFeatures = 60;
  std::mt19937 random(31);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Eigen::Isometry3d pose = BenchPose();
  std::vector<correspondence::FeatureMatch> all(kFeatures);
  for (correspondence::FeatureMatch& match : all) {
    match.state = correspondence::MatchState::kMatched;
    match.sigma_m = 1e-5;
    match.position_m = {0.12 * uniform(random), 0.12 * uniform(random),
                        0.45 + 0.08 * uniform(random)};
    const Eigen::Vector3d normal(uniform(random), uniform(random), -1.0);
    match.normal = pose.linear() * normal.normalized();
    match.target_m = match.normal.dot(pose.linear() * bias_m(match.position_m));
  }
  std::vector<correspondence::FeatureMatch> half = all;
  for (size_t k = 0; k < kFeatures; k += 2) half[k].state = correspondence::MatchState::kHidden;
  DepthBias bias(kFeatures, config);
  for (int frame = 0; frame < 10; ++frame) bias.Learn(half, Eigen::VectorXd::Zero(3), pose);
  ASSERT_TRUE(bias.Finish().ok());
  double largest_m = 0.0;
  for (int k = 0; k < kFeatures; k += 2) {
    const correspondence::FeatureMatch& match = all[static_cast<size_t>(k)];
    EXPECT_NEAR(bias.Correction_m(k, match, pose), match.target_m, 2e-5);
    largest_m = std::max(largest_m, std::abs(match.target_m));
  }
  EXPECT_GT(largest_m, 3e-4);
}

TEST(DepthBias, TellsAShiftAndATurnOfTheCamera) {
  ShapeConfig config;
  config.depth_bias_prior = 1e-7;
  config.feature_offset_prior_m = 1e-7;
  ExpectToldFromHalf(config, [](const Eigen::Vector3d& position_m) {
    return Eigen::Vector3d(Eigen::Vector3d(5e-4, -4e-4, 3e-4) +
                           Eigen::Vector3d(2e-3, -1e-3, 3e-3).cross(position_m));
  });
}

TEST(DepthBias, TellsADepthBiasOfSecondOrder) {
  ShapeConfig config;
  config.pose_prior_m = 1e-7;
  config.pose_prior_rad = 1e-7;
  config.feature_offset_prior_m = 1e-7;
  ExpectToldFromHalf(config, [](const Eigen::Vector3d& position_m) {
    const double x = position_m.x() / position_m.z();
    const double y = position_m.y() / position_m.z();
    const double share = 2e-3 - 3e-3 * x + 4e-3 * y + 5e-3 * x * x - 6e-3 * x * y - 4e-3 * y * y;
    return Eigen::Vector3d(share * position_m);
  });
}

TEST(DepthBias, AFeatureNotSeenYetKeepsThePriorOfItsOffset) {
  const ShapeScene& scene = FourLegScene();
  SurfaceMatching matching(*scene.features, {});
  std::vector<correspondence::FeatureMatch> matches =
      matching.Match(FrameOf(BiasedCloud(scene.rest_x_m)), scene.rest_x_m);
  const auto left_out = std::find_if(matches.begin(), matches.end(), [](const auto& match) {
    return match.state == correspondence::MatchState::kMatched;
  });
  ASSERT_NE(left_out, matches.end());
  const correspondence::FeatureMatch kept = *left_out;
  const int feature = static_cast<int>(left_out - matches.begin());
  left_out->state = correspondence::MatchState::kHidden;
  DepthBias bias(scene.features->Count(), {});
  for (int frame = 0; frame < 10; ++frame) bias.Learn(matches, scene.rest_x_m, BenchPose());
  ASSERT_TRUE(bias.Finish().ok());
  const double error_m =
      Residual_m(kept, scene.rest_x_m) - bias.Correction_m(feature, kept, BenchPose());
  const double sigma_m = bias.CorrectionSigma_m(feature, kept, BenchPose());
  EXPECT_GE(sigma_m, 3e-4);  // ShapeConfig::feature_offset_prior_m
  EXPECT_LT(sigma_m, 6e-4);
  EXPECT_LT(std::abs(error_m), 3e-4);
}

}  // namespace
}  // namespace palpate::force_estimation
