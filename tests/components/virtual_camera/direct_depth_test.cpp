// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// Depth along the ray: time of flight, and no noise at all.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/components/virtual_camera/bench.hpp"
#include "tests/components/virtual_camera/depth_errors.hpp"

namespace palpate::virtual_camera {
namespace {

WallBench FlightWall(double distance_m, const Eigen::Vector3d& rgb, double tilt_rad = 0.0) {
  WallBench bench = FacingWall(distance_m, tilt_rad);
  bench.scenario.stage.robot_color_rgb = rgb;
  bench.scenario.camera->camera.depth_unit_m = 2.5e-5;
  bench.scenario.camera->noise.sensor = scenario::DepthSensor::kTimeOfFlight;
  bench.scenario.camera->noise.low_frequency_bias = 0.0;
  return bench;
}

// Standard deviation of the range (along the ray) in the middle of the picture.
double RangeSigma(const WallBench& bench) {
  VirtualCamera camera(bench.scenario, bench.surface, {}, 3);
  rgbd::RgbdFrame frame;
  camera.Take(bench.view, &frame);
  std::vector<double> errors;
  for (int v = 190; v < 290; ++v) {
    for (int u = 374; u < 474; ++u) {
      const double truth = static_cast<double>(*camera.true_range().Pixel(u, v));
      errors.push_back(DepthAt(frame, bench.scenario, u, v) - truth);
    }
  }
  return MomentsOf(errors).sigma;
}

TEST(TimeOfFlight, NoiseIsThatOfTheSheetAtAMetreOnWhite) {
  EXPECT_NEAR(RangeSigma(FlightWall(1.0, {1.0, 1.0, 1.0})), 0.002, 0.0001);
}

TEST(TimeOfFlight, NoiseGrowsAsLightReturnsLess) {
  const double white = RangeSigma(FlightWall(1.0, {1.0, 1.0, 1.0}));
  EXPECT_NEAR(RangeSigma(FlightWall(1.5, {1.0, 1.0, 1.0})) / white, 2.25, 0.1);
  EXPECT_NEAR(RangeSigma(FlightWall(1.0, {0.5, 0.5, 0.5})) / white, 1.0 / 0.575, 0.08);
  EXPECT_NEAR(RangeSigma(FlightWall(1.0, {1.0, 1.0, 1.0}, 1.0)) / white, 1.0 / std::cos(1.0), 0.1);
}

TEST(TimeOfFlight, TooLittleLightMeasuresNothing) {
  WallBench bench = FlightWall(3.5, {0.0, 0.0, 0.0});
  bench.scenario.camera->camera.depth_unit_m = 1e-4;
  VirtualCamera camera(bench.scenario, bench.surface, {}, 3);
  rgbd::RgbdFrame frame;
  camera.Take(bench.view, &frame);
  EXPECT_TRUE(IsHole(frame, 424, 240));
}

TEST(TimeOfFlight, MixesFrontAndBackAlongEdges) {
  WallBench bench = FlightWall(0.8, {1.0, 1.0, 1.0});
  scenario::Tool ball;
  ball.name = "ball";
  ball.radius_m = 0.05;
  bench.scenario.tools = {ball};
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(0.0, -0.5, 0.0);
  bench.view.tools = {{"ball", pose}};
  VirtualCamera camera(bench.scenario, bench.surface, {}, 3);
  rgbd::RgbdFrame frame;
  camera.Take(bench.view, &frame);
  int flying = 0;
  int holes = 0;
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 848; ++u) {
      const double z = DepthAt(frame, bench.scenario, u, v);
      flying += z > 0.53 && z < 0.76 ? 1 : 0;
      holes += z == 0.0 ? 1 : 0;
    }
  }
  // The rim is about 420 px long and has pixels on both sides.
  EXPECT_GT(flying, 30);
  EXPECT_LT(flying, 150);
  EXPECT_GT(holes, 200);
  EXPECT_LT(holes, 700);
}

TEST(WithoutNoise, DepthIsTheTruthInWholeSteps) {
  scenario::Scenario scenario = QuietScenario();
  scenario.camera->camera.depth_unit_m = 2.5e-4;
  VirtualCamera camera(scenario, FourLegSurface(), {}, 3);
  rgbd::RgbdFrame frame;
  camera.Take(CrowdedView(scenario), &frame);
  int seen = 0;
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 848; ++u) {
      const double truth = static_cast<double>(*camera.true_range().Pixel(u, v));
      const double z = DepthAt(frame, scenario, u, v);
      if (std::isnan(truth)) {
        EXPECT_EQ(z, 0.0);
        continue;
      }
      ++seen;
      ASSERT_NEAR(z, truth, 0.5001 * 2.5e-4) << u << ", " << v;
    }
  }
  EXPECT_GT(seen, 300000);
}

TEST(WithoutNoise, WhatIsTooFarForTheDepthUnitIsInvalid) {
  WallBench bench = FacingWall(7.0);
  bench.scenario.camera->noise.sensor = scenario::DepthSensor::kNone;
  bench.scenario.camera->camera.invalid_value = 65535;
  VirtualCamera camera(bench.scenario, bench.surface, {}, 3);
  rgbd::RgbdFrame frame;
  camera.Take(bench.view, &frame);
  EXPECT_EQ(*frame.depth.Pixel(424, 240), 65535);
}

}  // namespace
}  // namespace palpate::virtual_camera
