// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// The laws of a stereo camera's noise (docs/architecture.md, "Depth noise").

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/components/virtual_camera/bench.hpp"
#include "tests/components/virtual_camera/depth_errors.hpp"

namespace palpate::virtual_camera {
namespace {

using ::testing::AllOf;
using ::testing::Ge;
using ::testing::Le;

constexpr double kStereoFocalBaseline = 665.0 * 0.055;

// A wall seen without anything but the sub-pixel noise; depth steps too small to matter.
WallBench PlainWall(double distance_m, double tilt_rad = 0.0) {
  WallBench bench = FacingWall(distance_m, tilt_rad);
  bench.scenario.camera->camera.depth_unit_m = 2e-5;
  scenario::DepthNoise& noise = bench.scenario.camera->noise;
  noise.periodic_bias_px = 0.0;
  noise.low_frequency_bias = 0.0;
  noise.disparity_step_px = 1e-4;
  return bench;
}

// z - truth in the columns [200, 800), where the other imager sees the wall too.
std::vector<double> ErrorsOf(const VirtualCamera& camera, const rgbd::RgbdFrame& frame,
                             const scenario::Scenario& scenario, int first_u = 200) {
  std::vector<double> errors;
  for (int v = 0; v < 480; ++v) {
    for (int u = first_u; u < first_u + 600; ++u) {
      const double truth = static_cast<double>(*camera.true_range().Pixel(u, v));
      errors.push_back(DepthAt(frame, scenario, u, v) - truth);
    }
  }
  return errors;
}

TEST(StereoNoise, GrowsWithTheSquareOfTheDistance) {
  const double sigmas_mm[] = {0.20, 0.44, 0.79, 2.19};
  const double distances_m[] = {0.3, 0.45, 0.6, 1.0};
  for (int i = 0; i < 4; ++i) {
    WallBench bench = PlainWall(distances_m[i]);
    bench.scenario.camera->noise.disparity_step_px = 1.0 / 32.0;
    VirtualCamera camera(bench.scenario, bench.surface, {}, 5);
    rgbd::RgbdFrame frame;
    camera.Take(bench.view, &frame);
    const Moments error = MomentsOf(ErrorsOf(camera, frame, bench.scenario));
    EXPECT_NEAR(1e3 * error.sigma, sigmas_mm[i], 0.03 * sigmas_mm[i]) << distances_m[i];
    EXPECT_NEAR(error.mean, 0.0, 0.05 * error.sigma) << distances_m[i];
  }
}

TEST(StereoNoise, IsCorrelatedOverTheLengthAskedFor) {
  for (const double length_px : {0.0, 1.5, 4.0}) {
    WallBench bench = PlainWall(0.5);
    bench.scenario.camera->noise.correlation_px = length_px;
    VirtualCamera camera(bench.scenario, bench.surface, {}, 7);
    rgbd::RgbdFrame frame;
    camera.Take(bench.view, &frame);
    const std::vector<double> here = ErrorsOf(camera, frame, bench.scenario);
    for (int lag = 1; lag <= 4; ++lag) {
      const std::vector<double> beside = ErrorsOf(camera, frame, bench.scenario, 200 + lag);
      const std::vector<double> below(here.begin() + 600 * lag, here.end());
      const std::vector<double> above(here.begin(), here.end() - 600 * lag);
      const double wanted = length_px == 0.0 ? 0.0 : std::exp(-std::pow(lag / length_px, 2));
      EXPECT_NEAR(Correlation(here, beside), wanted, 0.03) << length_px << " px, lag " << lag;
      EXPECT_NEAR(Correlation(above, below), wanted, 0.03) << length_px << " px, lag " << lag;
    }
  }
}

TEST(StereoNoise, RemembersTheLastFrame) {
  const WallBench bench = PlainWall(0.5);
  VirtualCamera camera(bench.scenario, bench.surface, {}, 7);
  std::vector<std::vector<double>> errors;
  for (int i = 0; i < 3; ++i) {
    rgbd::RgbdFrame frame;
    camera.Take(bench.view, &frame);
    errors.push_back(ErrorsOf(camera, frame, bench.scenario));
  }
  EXPECT_NEAR(Correlation(errors[0], errors[1]), 0.3, 0.02);
  EXPECT_NEAR(Correlation(errors[0], errors[2]), 0.09, 0.02);
  EXPECT_NEAR(MomentsOf(errors[2]).sigma / MomentsOf(errors[0]).sigma, 1.0, 0.02);
}

TEST(StereoNoise, FollowsTheNormalDistribution) {
  const WallBench bench = PlainWall(0.5);
  VirtualCamera camera(bench.scenario, bench.surface, {}, 9);
  rgbd::RgbdFrame frame;
  camera.Take(bench.view, &frame);
  const std::vector<double> errors = ErrorsOf(camera, frame, bench.scenario);
  const Moments moments = MomentsOf(errors);
  double fourth = 0.0;
  int beyond_three = 0;
  for (const double error : errors) {
    const double t = (error - moments.mean) / moments.sigma;
    fourth += std::pow(t, 4) / static_cast<double>(errors.size());
    beyond_three += std::abs(t) > 3.0 ? 1 : 0;
  }
  EXPECT_NEAR(fourth, 3.0, 0.1);
  EXPECT_NEAR(beyond_three / static_cast<double>(errors.size()), 0.0027, 0.0008);
}

TEST(StereoNoise, RoundsDisparityAndThenDepth) {
  WallBench bench = FacingWall(0.5, 0.5);
  bench.scenario.camera->noise.low_frequency_bias = 0.0;
  VirtualCamera camera(bench.scenario, bench.surface, {}, 3);
  rgbd::RgbdFrame frame;
  camera.Take(bench.view, &frame);
  const double unit_m = bench.scenario.camera->camera.depth_unit_m;
  int seen = 0;
  for (int u = 300; u < 700; ++u) {
    const int raw = *frame.depth.Pixel(u, 240);
    if (raw == 0) continue;
    ++seen;
    // Some whole number of 1/32 px gives this step of depth.
    const double steps = 32.0 * kStereoFocalBaseline / (raw * unit_m);
    const double z_m = 32.0 * kStereoFocalBaseline / std::round(steps);
    EXPECT_EQ(raw, static_cast<int>(std::lround(z_m / unit_m))) << u;
  }
  EXPECT_GT(seen, 350);
}

TEST(StereoNoise, IsBiasedPeriodicallyWithinAPixelOfDisparity) {
  WallBench bench = PlainWall(0.5, 0.5);
  bench.scenario.camera->noise.subpixel_px = 0.0;
  bench.scenario.camera->noise.periodic_bias_px = 0.05;
  VirtualCamera camera(bench.scenario, bench.surface, {}, 3);
  rgbd::RgbdFrame frame;
  camera.Take(bench.view, &frame);
  double largest = 0.0;
  for (int v = 0; v < 480; v += 7) {
    for (int u = 300; u < 700; ++u) {
      const double exact =
          kStereoFocalBaseline / static_cast<double>(*camera.true_range().Pixel(u, v));
      const double measured = kStereoFocalBaseline / DepthAt(frame, bench.scenario, u, v);
      const double wanted = 0.05 * std::sin(2.0 * M_PI * exact);
      largest = std::max(largest, std::abs(measured - exact - wanted));
    }
  }
  EXPECT_LT(largest, 0.003);  // half a depth step is 0.0015 px
}

TEST(StereoNoise, IsBiasedSmoothlyOverTheImage) {
  WallBench bench = PlainWall(0.5);
  scenario::DepthNoise& noise = bench.scenario.camera->noise;
  noise.subpixel_px = 0.0;
  noise.low_frequency_bias = 0.004;
  VirtualCamera camera(bench.scenario, bench.surface, {}, 3);
  rgbd::RgbdFrame frame;
  camera.Take(bench.view, &frame);
  std::vector<double> shares;
  double steepest = 0.0;
  for (int v = 0; v < 480; ++v) {
    for (int u = 100; u < 848; ++u) {
      shares.push_back(DepthAt(frame, bench.scenario, u, v) / 0.5 - 1.0);
      if (u > 100) {
        steepest = std::max(steepest, std::abs(shares.back() - shares[shares.size() - 2]));
      }
    }
  }
  double squares = 0.0;
  for (const double share : shares) squares += share * share;
  // Over the whole image it is exactly 0.004; a tenth of it is hidden here.
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(shares.size())), 0.004, 0.0008);
  EXPECT_LT(steepest, 3e-4);
}

// A plate of `width_m` before a wall, both facing the camera, in the middle of the picture.
struct PlateBefore {
  static constexpr double kPlate_m = 0.4;
  static constexpr double kWall_m = 0.8;
  static constexpr int kTop = 60;
  static constexpr int kBottom = 420;
  WallBench bench = FacingWall(kWall_m);
  int first_u = 0;  ///< the plate's columns
  int last_u = 0;

  explicit PlateBefore(double width_m) {
    scenario::Tool plate;
    plate.name = "plate";
    plate.shape = scenario::ToolShape::kPlate;
    plate.size_m = {width_m, 1e-4, 0.26};
    bench.scenario.tools = {plate};
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = Eigen::Vector3d(0.0, kPlate_m - 1.0 + 5e-5, 0.0);
    bench.view.tools = {{"plate", pose}};
    const double half_px = 0.5 * width_m / kPlate_m * 665.0;
    first_u = static_cast<int>(std::ceil(423.7 - half_px));
    last_u = static_cast<int>(std::floor(423.7 + half_px));
  }

  // Share of holes in the columns [from, to] of the rows that the plate crosses.
  double Holes(const rgbd::RgbdFrame& frame, int from, int to) const {
    int holes = 0;
    for (int v = kTop; v < kBottom; ++v) {
      for (int u = from; u <= to; ++u) holes += IsHole(frame, u, v) ? 1 : 0;
    }
    return holes / static_cast<double>((kBottom - kTop) * (to - from + 1));
  }
};

TEST(StereoHoles, TheShadowLiesToTheLeftAndIsAsWideAsTheDisparitiesDiffer) {
  const PlateBefore scene(0.08);
  VirtualCamera camera(scene.bench.scenario, scene.bench.surface, {}, 3);
  rgbd::RgbdFrame frame;
  camera.Take(scene.bench.view, &frame);
  const int shadow = static_cast<int>(kStereoFocalBaseline / PlateBefore::kPlate_m -
                                      kStereoFocalBaseline / PlateBefore::kWall_m);  // 45 px
  EXPECT_EQ(scene.Holes(frame, scene.first_u - shadow + 1, scene.first_u - 2), 1.0);
  EXPECT_EQ(scene.Holes(frame, scene.first_u - shadow - 40, scene.first_u - shadow - 2), 0.0);
  EXPECT_EQ(scene.Holes(frame, scene.first_u + 1, scene.last_u - 1), 0.0);
  EXPECT_EQ(scene.Holes(frame, scene.last_u + 2, scene.last_u + 60), 0.0);
}

TEST(StereoHoles, BehindANarrowThingTheOtherImagerSeesOnBothSides) {
  const PlateBefore scene(0.008);  // 13 px, less than the 45 px between the two views
  VirtualCamera camera(scene.bench.scenario, scene.bench.surface, {}, 3);
  rgbd::RgbdFrame frame;
  camera.Take(scene.bench.view, &frame);
  const int shift = static_cast<int>(kStereoFocalBaseline / PlateBefore::kPlate_m -
                                     kStereoFocalBaseline / PlateBefore::kWall_m);
  EXPECT_EQ(scene.Holes(frame, scene.first_u - shift + 2, scene.last_u - shift - 2), 1.0);
  EXPECT_EQ(scene.Holes(frame, scene.last_u - shift + 3, scene.first_u - 3), 0.0);
}

TEST(StereoHoles, TheLeftBorderIsOutsideTheOtherImage) {
  const WallBench bench = FacingWall(0.5);
  VirtualCamera camera(bench.scenario, bench.surface, {}, 3);
  rgbd::RgbdFrame frame;
  camera.Take(bench.view, &frame);
  const int border = static_cast<int>(kStereoFocalBaseline / 0.5);  // 73 px
  for (int v = 0; v < 480; v += 20) {
    for (int u = 0; u < 848; ++u) {
      if (std::abs(u - border) <= 1) continue;
      EXPECT_EQ(IsHole(frame, u, v), u < border) << u;
    }
  }
}

TEST(StereoHoles, EdgesHaveHolesAndFlyingPixelsInTheShareAskedFor) {
  PlateBefore scene(0.08);
  int holes = 0;
  int flying = 0;
  int pixels = 0;
  VirtualCamera camera(scene.bench.scenario, scene.bench.surface, {}, 3);
  for (int i = 0; i < 50; ++i) {
    rgbd::RgbdFrame frame;
    camera.Take(scene.bench.view, &frame);
    for (int v = PlateBefore::kTop; v < PlateBefore::kBottom; ++v) {
      // On the right, where there is no shadow.
      for (const int u : {scene.last_u, scene.last_u + 1}) {
        const double z = DepthAt(frame, scene.bench.scenario, u, v);
        const double truth = static_cast<double>(*camera.true_range().Pixel(u, v));
        ++pixels;
        holes += z == 0.0 ? 1 : 0;
        const bool between = z > PlateBefore::kPlate_m && z < PlateBefore::kWall_m;
        flying += z != 0.0 && between && std::abs(z - truth) > 0.02 ? 1 : 0;
      }
    }
  }
  EXPECT_NEAR(holes / static_cast<double>(pixels), 0.5, 0.03);  // 3000 patches
  EXPECT_NEAR(flying / static_cast<double>(pixels), 0.1, 0.01);
}

TEST(StereoHoles, GrowBeyondTheGrazingAngle) {
  // Rays meet the tilted wall at every angle from 60 degrees on.
  const WallBench bench = FacingWall(0.6, 1.35);
  VirtualCamera camera(bench.scenario, bench.surface, {}, 3);
  rgbd::RgbdFrame frame;
  camera.Take(bench.view, &frame);
  std::array<int, 90> holes = {};
  std::array<int, 90> pixels = {};
  for (int v = 0; v < 480; ++v) {
    for (int u = 100; u < 848; ++u) {
      const double truth = static_cast<double>(*camera.true_range().Pixel(u, v));
      if (!(truth < 1.2)) continue;
      const Eigen::Vector3d ray((u - 423.7) / 665.0, (v - 239.2) / 665.0, 1.0);
      // The wall's normal in the camera's frame.
      const Eigen::Vector3d normal(-std::sin(1.35), 0.0, std::cos(1.35));
      const double cosine = std::abs(normal.dot(ray.normalized()));
      const auto degrees = static_cast<std::size_t>(std::acos(cosine) * 180.0 / M_PI);
      ++pixels[degrees];
      holes[degrees] += IsHole(frame, u, v) ? 1 : 0;
    }
  }
  const auto share = [&](std::size_t degrees) {
    EXPECT_GT(pixels[degrees], 1000) << degrees;
    return holes[degrees] / static_cast<double>(pixels[degrees]);
  };
  EXPECT_LT(share(65), 0.01);
  EXPECT_THAT(share(74), AllOf(Ge(0.15), Le(0.27)));  // 1 - cos 74.5 / cos 70 = 0.22
  EXPECT_GT(share(77), share(74) + 0.05);
}

}  // namespace
}  // namespace palpate::virtual_camera
