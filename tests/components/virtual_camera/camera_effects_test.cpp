// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// Effects of the catalogue that belong to the camera: the right thing of the right size happens,
// and size zero is no effect.

#include <gtest/gtest.h>

#include <cmath>

#include "components/virtual_camera/camera_faults.hpp"
#include "tests/components/virtual_camera/bench.hpp"
#include "tests/components/virtual_camera/depth_errors.hpp"

namespace palpate::virtual_camera {
namespace {

using Effects = std::vector<scenario::ActiveEffect>;

scenario::ActiveEffect Effect(const char* id, std::map<std::string, double> parameters) {
  return {.id = id, .where = {"camera"}, .parameters = std::move(parameters), .clutter = false};
}

struct Taken {
  rgbd::RgbdFrame frame;
  rgbd::RangeImage truth;
};

Taken TakeOne(const scenario::Scenario& scenario, const RobotSurface& surface, const View& view,
              const Effects& effects, std::uint64_t seed = 4) {
  VirtualCamera camera(scenario, surface, effects, seed);
  Taken taken;
  camera.Take(view, &taken.frame);
  taken.truth = camera.true_range();
  return taken;
}

// A wall at 0.5 m, no noise, fine depth steps.
WallBench QuietWall(double tilt_rad = 0.0) {
  WallBench bench = FacingWall(0.5, tilt_rad);
  bench.scenario.camera->noise.sensor = scenario::DepthSensor::kNone;
  bench.scenario.camera->camera.depth_unit_m = 1e-5;
  return bench;
}

TEST(CameraEffects, OfSizeZeroChangeNothing) {
  const scenario::Scenario scenario = NoisyScenario();
  const View view = CrowdedView(scenario);
  const Taken healthy = TakeOne(scenario, FourLegSurface(), view, {});
  const Effects zero = {
      Effect("camera_moved",
             {{"translation_m", 0.0}, {"rotation_rad", 0.0}, {"from_recording", 0.0}}),
      Effect("depth_scale", {{"s", 0.0}}),
      Effect("intrinsics", {{"focal", 0.0}, {"cx_px", 0.0}, {"cy_px", 0.0}}),
      Effect("lens_distortion", {{"k1", 0.0}}),
      Effect("depth_incidence_bias", {{"b_m", 0.0}}),
      Effect("flying_pixels", {{"ratio", 0.0}}),
      Effect("warm_up_drift", {{"amplitude_m", 0.0}, {"tau_s", 60.0}})};
  for (const scenario::ActiveEffect& effect : zero) {
    const Taken taken = TakeOne(scenario, FourLegSurface(), view, {effect});
    EXPECT_EQ(taken.frame.depth, healthy.frame.depth) << effect.id;
    EXPECT_EQ(taken.frame.color, healthy.frame.color) << effect.id;
  }
}

TEST(CameraEffects, OfBodyAndDrivesDoNotActHere) {
  const scenario::Scenario scenario = NoisyScenario();
  const View view = RestingView(scenario);
  const Taken healthy = TakeOne(scenario, FourLegSurface(), view, {});
  const Taken taken = TakeOne(
      scenario, FourLegSurface(), view,
      {Effect("youngs_modulus", {{"factor", 1.3}}), Effect("cable_friction", {{"mu", 0.2}})});
  EXPECT_EQ(taken.frame.depth, healthy.frame.depth);
}

TEST(CameraEffects, CameraMovedTakesThePictureFromElsewhereFromOneRecordingOn) {
  const scenario::Scenario scenario = QuietScenario();
  View view = RestingView(scenario);
  const scenario::ActiveEffect moved = Effect(
      "camera_moved", {{"translation_m", 0.012}, {"rotation_rad", 0.03}, {"from_recording", 2.0}});
  const CameraFaults faults = FaultsFrom({moved}, 4);
  for (const int recording : {0, 1, 2, 3}) {
    const Eigen::Isometry3d pose = faults.MovedPose(view.T_robot_camera, recording);
    const Eigen::Isometry3d by = view.T_robot_camera.inverse() * pose;
    const bool acts = recording >= 2;
    EXPECT_NEAR(by.translation().norm(), acts ? 0.012 : 0.0, 1e-12);
    EXPECT_NEAR(Eigen::AngleAxisd(by.linear()).angle(), acts ? 0.03 : 0.0, 1e-9);
    view.recording = recording;
    const Taken taken = TakeOne(scenario, FourLegSurface(), view, {moved});
    View from_there = view;
    from_there.T_robot_camera = pose;
    const Taken wanted = TakeOne(scenario, FourLegSurface(), from_there, {});
    EXPECT_EQ(taken.frame.depth, wanted.frame.depth) << recording;
    EXPECT_EQ(taken.frame.color, wanted.frame.color) << recording;
  }
}

TEST(CameraEffects, CameraMovedGoesWhereTheSeedSays) {
  const scenario::ActiveEffect moved = Effect(
      "camera_moved", {{"translation_m", 0.01}, {"rotation_rad", 0.02}, {"from_recording", 0.0}});
  const auto pose = [&](std::uint64_t seed) {
    return FaultsFrom({moved}, seed).MovedPose(Eigen::Isometry3d::Identity(), 0);
  };
  EXPECT_TRUE(pose(1).isApprox(pose(1), 0.0));
  EXPECT_GT((pose(1).translation() - pose(2).translation()).norm(), 1e-3);
  // All directions alike: the mean of many is small.
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::uint64_t seed = 0; seed < 400; ++seed) sum += pose(seed).translation() / 0.01;
  EXPECT_LT(sum.norm() / 400.0, 0.12);
}

TEST(CameraEffects, DepthScaleActsAlongTheRay) {
  const WallBench bench = QuietWall(0.4);
  const Taken taken =
      TakeOne(bench.scenario, bench.surface, bench.view, {Effect("depth_scale", {{"s", -0.019}})});
  for (int u = 10; u < 840; u += 50) {
    const double truth = static_cast<double>(*taken.truth.Pixel(u, 100));
    if (truth > 0.6) continue;
    EXPECT_NEAR(DepthAt(taken.frame, bench.scenario, u, 100), 0.981 * truth, 6e-6) << u;
  }
}

TEST(CameraEffects, EffectsOfOneKindAddUp) {
  const WallBench bench = QuietWall();
  const Taken taken = TakeOne(bench.scenario, bench.surface, bench.view,
                              {Effect("depth_scale", {{"s", 0.02}}),  //
                               Effect("depth_scale", {{"s", 0.001}})});
  EXPECT_NEAR(DepthAt(taken.frame, bench.scenario, 424, 240), 0.5 * 1.021, 6e-6);
}

// The pixel in which the camera sees the left edge of a ball's rim in row 239, to a tenth.
double LeftEdge(const rgbd::RangeImage& truth, int v) {
  for (int u = 0; u < truth.width_px; ++u) {
    if (*truth.Pixel(u, v) < 0.45F) return u;
  }
  return -1.0;
}
double RightEdge(const rgbd::RangeImage& truth, int v) {
  for (int u = truth.width_px - 1; u >= 0; --u) {
    if (*truth.Pixel(u, v) < 0.45F) return u;
  }
  return -1.0;
}

// A plate 0.3 m wide and 0.2 m high at 0.4 m before the wall.
WallBench PlateBench() {
  WallBench bench = QuietWall();
  scenario::Tool plate;
  plate.name = "plate";
  plate.shape = scenario::ToolShape::kPlate;
  plate.size_m = {0.3, 1e-4, 0.2};
  bench.scenario.tools = {plate};
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(0.0, -0.6 + 5e-5, 0.0);
  bench.view.tools = {{"plate", pose}};
  return bench;
}

TEST(CameraEffects, IntrinsicsChangeWherePixelsLook) {
  const WallBench bench = PlateBench();
  const Taken taken =
      TakeOne(bench.scenario, bench.surface, bench.view,
              {Effect("intrinsics", {{"focal", 0.02}, {"cx_px", 3.0}, {"cy_px", -5.0}})});
  const double half_px = 0.15 / 0.4 * 665.0 * 1.02;
  EXPECT_NEAR(LeftEdge(taken.truth, 239), 423.7 + 3.0 - half_px, 1.0);
  EXPECT_NEAR(RightEdge(taken.truth, 239), 423.7 + 3.0 + half_px, 1.0);
  const double top = 239.2 - 5.0 - 0.1 / 0.4 * 665.0 * 1.02;
  EXPECT_LT(*taken.truth.Pixel(424, static_cast<int>(top) + 2), 0.45F);
  EXPECT_GT(*taken.truth.Pixel(424, static_cast<int>(top) - 2), 0.45F);
  // What the depth image says remains true along the axis.
  EXPECT_NEAR(DepthAt(taken.frame, bench.scenario, 424, 239), 0.4, 6e-6);
}

TEST(CameraEffects, LensDistortionBendsWhereTheDataSheetHasNone) {
  const WallBench bench = PlateBench();
  const Taken taken = TakeOne(bench.scenario, bench.surface, bench.view,
                              {Effect("lens_distortion", {{"k1", -0.1}})});
  const double x = 0.15 / 0.4;
  const double wanted = 665.0 * x * (1.0 - 0.1 * x * x);
  EXPECT_NEAR(LeftEdge(taken.truth, 239), 423.7 - wanted, 1.0);
  EXPECT_NEAR(RightEdge(taken.truth, 239), 423.7 + wanted, 1.0);
}

TEST(CameraEffects, IncidenceBiasGrowsWithTheAngle) {
  const double b_m = 0.003;
  for (const double tilt_rad : {0.0, 0.5, 1.0}) {
    const WallBench bench = QuietWall(tilt_rad);
    const Taken taken = TakeOne(bench.scenario, bench.surface, bench.view,
                                {Effect("depth_incidence_bias", {{"b_m", b_m}})});
    const Eigen::Vector3d normal(-std::sin(tilt_rad), 0.0, std::cos(tilt_rad));
    for (int u = 224; u <= 624; u += 40) {
      const Eigen::Vector3d ray((u - 423.7) / 665.0, (100 - 239.2) / 665.0, 1.0);
      const double cosine = std::abs(normal.dot(ray.normalized()));
      const double truth = static_cast<double>(*taken.truth.Pixel(u, 100));
      if (truth > 0.6 || cosine < 0.1) continue;
      const double along_ray = (DepthAt(taken.frame, bench.scenario, u, 100) - truth) * ray.norm();
      const double slant = 1.0 / std::max(cosine, 0.25) - 1.0;
      EXPECT_NEAR(along_ray, b_m * slant, 1e-5) << tilt_rad << " rad, " << u;
    }
  }
}

TEST(CameraEffects, IncidenceBiasKnowsTheAngleOnABall) {
  WallBench bench = QuietWall();
  scenario::Tool ball;
  ball.name = "ball";
  ball.radius_m = 0.05;
  bench.scenario.tools = {ball};
  const Eigen::Vector3d center(0.0, 0.0, 0.3);  // camera frame
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = bench.view.T_robot_camera * center;
  bench.view.tools = {{"ball", pose}};
  const Taken taken = TakeOne(bench.scenario, bench.surface, bench.view,
                              {Effect("depth_incidence_bias", {{"b_m", 0.003}})});
  for (int u = 340; u < 510; u += 10) {
    const double truth = static_cast<double>(*taken.truth.Pixel(u, 239));
    if (truth > 0.3) continue;
    const Eigen::Vector3d ray((u - 423.7) / 665.0, (239 - 239.2) / 665.0, 1.0);
    const double cosine = -((truth * ray - center) / 0.05).dot(ray.normalized());
    if (cosine < 0.1) continue;
    const double along_ray = (DepthAt(taken.frame, bench.scenario, u, 239) - truth) * ray.norm();
    EXPECT_NEAR(along_ray, 0.003 * (1.0 / std::max(cosine, 0.25) - 1.0), 2e-5) << u;
  }
}

int CountBetween(const Taken& taken, const scenario::Scenario& scenario, double from, double to) {
  int count = 0;
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 848; ++u) {
      const double z = DepthAt(taken.frame, scenario, u, v);
      count += z > from && z < to ? 1 : 0;
    }
  }
  return count;
}

TEST(CameraEffects, FlyingPixelsAreSoManyMoreAlongEdges) {
  WallBench bench = PlateBench();
  const auto flying = [&](double ratio) {
    const Taken taken = TakeOne(bench.scenario, bench.surface, bench.view,
                                {Effect("flying_pixels", {{"ratio", ratio}})});
    return CountBetween(taken, bench.scenario, 0.401, 0.499);
  };
  const double edge = 2.0 * 2.0 * (0.3 + 0.2) / 0.4 * 665.0;  // px on both sides of the rim
  EXPECT_EQ(flying(0.0), 0);
  EXPECT_NEAR(flying(0.2) / edge, 0.2, 0.04);
  EXPECT_NEAR(flying(0.6) / edge, 0.6, 0.06);
  bench.scenario.camera->noise = {};
  bench.scenario.camera->noise.flying_pixel_ratio = 0.0;
  EXPECT_GT(flying(0.4), flying(0.0) + 200);
}

TEST(CameraEffects, WarmUpDriftComesAndStays) {
  WallBench bench = QuietWall();
  const Effects drift = {Effect("warm_up_drift", {{"amplitude_m", 0.004}, {"tau_s", 300.0}})};
  for (const double t_s : {0.0, 100.0, 300.0, 3000.0}) {
    bench.view.t_s = t_s;
    const Taken taken = TakeOne(bench.scenario, bench.surface, bench.view, drift);
    EXPECT_NEAR(DepthAt(taken.frame, bench.scenario, 424, 240),
                0.5 + 0.004 * (1.0 - std::exp(-t_s / 300.0)), 6e-6)
        << t_s;
  }
}

}  // namespace
}  // namespace palpate::virtual_camera
