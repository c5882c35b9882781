// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// The colour image: where things are seen in it, what sticks to the surface, light and noise.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/components/virtual_camera/bench.hpp"
#include "tests/components/virtual_camera/depth_errors.hpp"

namespace palpate::virtual_camera {
namespace {

rgbd::ColorImage ColorOf(const scenario::Scenario& scenario, const RobotSurface& surface,
                         const View& view, std::uint64_t seed = 1) {
  VirtualCamera camera(scenario, surface, {}, seed);
  rgbd::RgbdFrame frame;
  camera.Take(view, &frame);
  return frame.color;
}

// Grey robot, one green ball at `center` of the depth camera's frame, on a wall.
WallBench BallBench(const Eigen::Vector3d& center_depth) {
  WallBench bench = FacingWall(1.0);
  bench.scenario.stage.robot_color_rgb = {0.5, 0.5, 0.5};
  scenario::Tool ball;
  ball.name = "ball";
  ball.radius_m = 0.02;
  ball.color_rgb = {0.0, 0.9, 0.0};
  bench.scenario.tools = {ball};
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = bench.view.T_robot_camera * center_depth;
  bench.view.tools = {{"ball", pose}};
  return bench;
}

struct Spot {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  int pixels = 0;
};
// Pixels in which one channel stands out by `by` over both others.
Spot FindSpot(const rgbd::ColorImage& color, int channel, int by) {
  Spot spot;
  for (int v = 0; v < color.height_px; ++v) {
    for (int u = 0; u < color.width_px; ++u) {
      const std::uint8_t* pixel = color.Pixel(u, v);
      const int others = std::max(pixel[(channel + 1) % 3], pixel[(channel + 2) % 3]);
      if (pixel[channel] - others < by) continue;
      spot.center += Eigen::Vector2d(u, v);
      ++spot.pixels;
    }
  }
  if (spot.pixels > 0) spot.center /= spot.pixels;
  return spot;
}

TEST(Color, IsSeenFromTheColorCamerasOwnPlaceWithItsOwnLens) {
  const Eigen::Vector3d center(0.06, -0.03, 0.5);
  WallBench bench = BallBench(center);
  rgbd::RgbdCamera& camera = bench.scenario.camera->camera;
  camera.T_depth_color.linear() =
      Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitY()).toRotationMatrix();
  for (const double k1 : {0.0, 0.15}) {
    camera.color.distortion[0] = k1;
    const Spot spot = FindSpot(ColorOf(bench.scenario, bench.surface, bench.view), 1, 60);
    const Eigen::Vector2d wanted =
        rgbd::Project(camera.color, camera.T_depth_color.inverse() * center);
    EXPECT_GT(spot.pixels, 500);
    EXPECT_NEAR((spot.center - wanted).norm(), 0.0, 0.5) << k1;
  }
}

TEST(Color, RegisteredIsSeenFromTheDepthCamera) {
  const Eigen::Vector3d center(0.06, -0.03, 0.5);
  WallBench bench = BallBench(center);
  rgbd::RgbdCamera& camera = bench.scenario.camera->camera;
  camera.color_registered = true;
  camera.color.width_px = 640;  // of no account: colour has the depth image's pixels
  const rgbd::ColorImage color = ColorOf(bench.scenario, bench.surface, bench.view);
  EXPECT_EQ(color.width_px, camera.depth.width_px);
  const Spot spot = FindSpot(color, 1, 60);
  EXPECT_NEAR((spot.center - rgbd::Project(camera.depth, center)).norm(), 0.0, 0.5);
}

TEST(Color, WithoutAColorCameraThereIsNone) {
  WallBench bench = FacingWall(0.5);
  bench.scenario.camera->camera.color.width_px = 0;
  EXPECT_TRUE(ColorOf(bench.scenario, bench.surface, bench.view).empty());
}

TEST(Color, MarkersStickToTheSkin) {
  scenario::Scenario scenario = QuietScenario();
  scenario.stage.robot_color_rgb = {0.6, 0.6, 0.6};  // so that the hues begin with yellow
  scenario.tools.clear();
  RobotSurface surface = FourLegSurface();
  Eigen::Index marked = 0;  // the node on the south side nearest to (0, -0.0598, 0.0858)
  (surface.rest_m.colwise() - Eigen::Vector3d(0.0, -0.0598, 0.0858))
      .colwise()
      .squaredNorm()
      .minCoeff(&marked);
  surface.markers_m = surface.rest_m.col(marked);
  View view = RestingView(scenario);
  for (const double bend : {0.0, 1.5}) {
    for (Eigen::Index i = 0; i < view.nodes_m.cols(); ++i) {
      view.nodes_m(0, i) = surface.rest_m(0, i) + bend * std::pow(surface.rest_m(2, i), 2);
    }
    // With a single marker its hue is halfway round from the robot's: cyan, weak in red.
    const rgbd::ColorImage color = ColorOf(scenario, surface, view);
    Spot spot;
    for (int v = 0; v < color.height_px; ++v) {
      for (int u = 0; u < color.width_px; ++u) {
        const std::uint8_t* pixel = color.Pixel(u, v);
        if (std::min(pixel[1], pixel[2]) - pixel[0] < 60) continue;
        spot.center += Eigen::Vector2d(u, v);
        ++spot.pixels;
      }
    }
    const rgbd::RgbdCamera& camera = scenario.camera->camera;
    const Eigen::Vector3d in_depth = view.T_robot_camera.inverse() * view.nodes_m.col(marked);
    const Eigen::Vector2d wanted =
        rgbd::Project(camera.color, camera.T_depth_color.inverse() * in_depth);
    ASSERT_GT(spot.pixels, 20) << bend;
    EXPECT_NEAR((spot.center / spot.pixels - wanted).norm(), 0.0, 1.0) << bend;
  }
}

TEST(Color, TheDiscHasTheRadiusOfTheStage) {
  WallBench bench = FacingWall(0.4);
  bench.scenario.stage.robot_color_rgb = {0.6, 0.6, 0.6};
  bench.surface.markers_m = Eigen::Vector3d(0.02, -0.6, 0.01);
  for (const double radius_m : {0.004, 0.008}) {
    bench.scenario.stage.marker_radius_m = radius_m;
    const rgbd::ColorImage color = ColorOf(bench.scenario, bench.surface, bench.view);
    // The disc is cyan on grey: blue less red is the light there, as far as the disc covers.
    double grey = 0.0;
    double covered = 0.0;
    for (int v = 180; v < 300; ++v) {
      for (int u = 380; u < 500; ++u) {
        grey += *color.Pixel(u - 120, v) / (120.0 * 120.0);
        covered += color.Pixel(u, v)[2] - color.Pixel(u, v)[0];
      }
    }
    covered /= grey / 0.6;
    const double radius_px = radius_m / 0.4 * 640.0;
    EXPECT_NEAR(covered / (M_PI * radius_px * radius_px), 1.0, 0.08) << radius_m;
  }
  bench.scenario.stage.marker_radius_m = 0.0;
  const rgbd::ColorImage color = ColorOf(bench.scenario, bench.surface, bench.view);
  for (int u = 400; u < 500; ++u) EXPECT_LT(*(color.Pixel(u, 224) + 2) - *color.Pixel(u, 224), 40);
}

// Grey levels of the middle of the wall, without their mean.
std::vector<double> Middle(const rgbd::ColorImage& color, int du) {
  std::vector<double> levels;
  for (int v = 200; v < 280; ++v) {
    for (int u = 380; u < 460; ++u) levels.push_back(*color.Pixel(u + du, v));
  }
  return levels;
}

TEST(Color, TheTextureMovesWithTheSkin) {
  WallBench bench = FacingWall(0.4);
  const rgbd::ColorImage before = ColorOf(bench.scenario, bench.surface, bench.view, 1);
  // 10 px to the right.
  bench.view.nodes_m.row(0).array() += 10.0 * 0.4 / 640.0;
  const rgbd::ColorImage after = ColorOf(bench.scenario, bench.surface, bench.view, 2);
  EXPECT_GT(Correlation(Middle(before, 0), Middle(after, 10)), 0.9);
  EXPECT_LT(Correlation(Middle(before, 0), Middle(after, 0)), 0.7);
  EXPECT_GT(MomentsOf(Middle(before, 0)).sigma, 4.0);
}

TEST(Color, TheLampsBrightnessIsThatOfTheStage) {
  WallBench bench = FacingWall(0.4);
  const double full = MomentsOf(Middle(ColorOf(bench.scenario, bench.surface, bench.view), 0)).mean;
  bench.scenario.stage.light = 0.5;
  const double half = MomentsOf(Middle(ColorOf(bench.scenario, bench.surface, bench.view), 0)).mean;
  EXPECT_NEAR(half / full, 0.5, 0.02);
}

TEST(Color, NoiseIsAGreyLevelOrTwo) {
  const WallBench bench = FacingWall(0.4);
  VirtualCamera camera(bench.scenario, bench.surface, {}, 3);
  rgbd::RgbdFrame first;
  rgbd::RgbdFrame second;
  camera.Take(bench.view, &first);
  camera.Take(bench.view, &second);
  for (int channel = 0; channel < 3; ++channel) {
    std::vector<double> differences;
    for (int v = 200; v < 280; ++v) {
      for (int u = 380; u < 460; ++u) {
        differences.push_back(first.color.Pixel(u, v)[channel] - second.color.Pixel(u, v)[channel]);
      }
    }
    const double sigma = MomentsOf(differences).sigma / std::sqrt(2.0);
    EXPECT_GT(sigma, 0.7);
    EXPECT_LT(sigma, 2.5);
  }
}

TEST(Color, CornersAreALittleDarker) {
  WallBench bench = FacingWall(0.4);
  const rgbd::ColorImage color = ColorOf(bench.scenario, bench.surface, bench.view);
  const auto mean = [&](int u0, int v0) {
    double sum = 0.0;
    for (int v = v0; v < v0 + 60; ++v) {
      for (int u = u0; u < u0 + 60; ++u) sum += *color.Pixel(u, v);
    }
    return sum / 3600.0;
  };
  const double middle = mean(394, 210);
  for (const double corner : {mean(0, 0), mean(788, 0), mean(0, 420), mean(788, 420)}) {
    EXPECT_GT(corner, 0.84 * middle);
    EXPECT_LT(corner, 0.97 * middle);
  }
}

TEST(Color, TheHandHasFingersOfSkin) {
  scenario::Scenario scenario = NoisyScenario();
  View view = CrowdedView(scenario);
  view.tools.erase(view.tools.begin(), view.tools.begin() + 3);
  const rgbd::ColorImage with = ColorOf(scenario, FourLegSurface(), view);
  view.tools.clear();
  const rgbd::ColorImage without = ColorOf(scenario, FourLegSurface(), view);
  int changed = 0;
  int of_surface = 0;
  for (std::size_t i = 0; i < with.values.size(); i += 3) {
    const int red = with.values[i];
    const int green = with.values[i + 1];
    const int blue = with.values[i + 2];
    const int difference = std::abs(red - without.values[i]) +
                           std::abs(green - without.values[i + 1]) +
                           std::abs(blue - without.values[i + 2]);
    if (difference < 40) continue;
    ++changed;
    of_surface += red > green && green > blue ? 1 : 0;
  }
  EXPECT_GT(changed, 15000);
  EXPECT_GT(of_surface, 0.95 * changed);
}

}  // namespace
}  // namespace palpate::virtual_camera
