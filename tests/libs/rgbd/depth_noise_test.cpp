// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/rgbd/depth_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate::rgbd {
namespace {

RgbdCamera StereoCamera() {
  RgbdCamera camera;
  camera.depth = {.width_px = 848,
                  .height_px = 480,
                  .fx_px = 425.0,
                  .fy_px = 430.0,
                  .cx_px = 423.5,
                  .cy_px = 239.5};
  camera.depth_unit_m = 1e-4;
  camera.baseline_m = 0.05;
  return camera;
}

TEST(DepthSigma, OfAStereoCameraIsThatOfTheDisparity) {
  const DepthNoise noise{.subpixel_px = 0.08};
  const double by_hand_m = 0.45 * 0.45 * 0.08 / (425.0 * 0.05);
  const double step_m = 1e-4 / std::sqrt(12.0);
  EXPECT_NEAR(DepthSigma_m(StereoCamera(), noise, 0.45), std::hypot(by_hand_m, step_m), 1e-15);
}

TEST(DepthSigma, OfAnyOtherCameraIsTheSameAtEveryDistance) {
  RgbdCamera camera = StereoCamera();
  camera.baseline_m = 0.0;
  const DepthNoise noise{.range_sigma_m = 2e-3};
  for (const double z_m : {0.2, 0.5, 3.0}) {
    EXPECT_NEAR(DepthSigma_m(camera, noise, z_m), std::hypot(2e-3, 1e-4 / std::sqrt(12.0)), 1e-15);
  }
}

TEST(DepthSigma, IsNeverBelowTheStepOfTheDepthValue) {
  RgbdCamera camera = StereoCamera();
  camera.depth_unit_m = 1e-3;
  EXPECT_NEAR(DepthSigma_m(camera, {.subpixel_px = 0.0}, 0.5), 1e-3 / std::sqrt(12.0), 1e-15);
}

TEST(IndependentPixels, AreAtLeastOneAndAtMostAll) {
  const DepthNoise noise{.correlation_px = 1.5};
  EXPECT_EQ(IndependentPixels(noise, 1.0), 1.0);
  EXPECT_EQ(IndependentPixels(noise, 9.0), 1.0);
  EXPECT_GT(IndependentPixels(noise, 1000.0), 10.0);
  EXPECT_LT(IndependentPixels(noise, 1000.0), 1000.0);
  EXPECT_EQ(IndependentPixels({.correlation_px = 0.0}, 50.0), 50.0);
  EXPECT_EQ(IndependentPixels({.correlation_px = 0.2}, 50.0), 50.0);
}

/// Variance of the mean of a block of noise whose neighbours err alike, white noise smoothed so
/// that the correlation is exp(-r^2 / (2 c^2)).
TEST(IndependentPixels, SayWhatTheMeanOfABlockIsWorth) {
  constexpr double kCorrelation_px = 1.5;
  constexpr int kBlock = 24;
  constexpr int kReach = 5;
  constexpr int kSide = kBlock + 2 * kReach;
  Eigen::MatrixXd kernel(2 * kReach + 1, 2 * kReach + 1);
  for (int v = -kReach; v <= kReach; ++v) {
    for (int u = -kReach; u <= kReach; ++u) {
      kernel(v + kReach, u + kReach) =
          std::exp(-(u * u + v * v) / (kCorrelation_px * kCorrelation_px));
    }
  }
  kernel /= kernel.norm();  // so that each pixel has variance 1
  // The block's mean is a weighted sum of the white noise: weights are counts of the kernel.
  Eigen::MatrixXd weight = Eigen::MatrixXd::Zero(kSide, kSide);
  for (int v = 0; v < kBlock; ++v) {
    for (int u = 0; u < kBlock; ++u) {
      weight.block(v, u, 2 * kReach + 1, 2 * kReach + 1) += kernel;
    }
  }
  const double variance = (weight / (kBlock * kBlock)).squaredNorm();
  const double independent =
      IndependentPixels({.correlation_px = kCorrelation_px}, kBlock * kBlock);
  EXPECT_NEAR(variance * independent, 1.0, 0.15);
}

}  // namespace
}  // namespace palpate::rgbd
