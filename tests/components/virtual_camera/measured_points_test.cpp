// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_camera/measured_points.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/components/virtual_camera/bench.hpp"
#include "tests/components/virtual_camera/depth_errors.hpp"

namespace palpate::virtual_camera {
namespace {

scenario::ActiveEffect EffectOn(const char* id, std::map<std::string, double> parameters) {
  return {.id = id, .where = {"camera"}, .parameters = std::move(parameters), .clutter = false};
}

TEST(MeasuredPoints, AreThoseOfThePicture) {
  constexpr double kTilt_rad = 0.5;
  constexpr double kTime_s = 40.0;
  WallBench bench = FacingWall(0.5, kTilt_rad);
  bench.scenario.camera->noise.sensor = scenario::DepthSensor::kNone;
  rgbd::RgbdCamera& camera = bench.scenario.camera->camera;
  camera.depth_unit_m = 1e-5;
  camera.depth.distortion = {-0.05, 0.02, 0.001, -0.002, 0.0};
  bench.view.t_s = kTime_s;
  const std::vector<scenario::ActiveEffect> effects = {
      EffectOn("depth_scale", {{"s", 0.02}}), EffectOn("depth_incidence_bias", {{"b_m", 0.004}}),
      EffectOn("intrinsics", {{"focal", 0.03}, {"cx_px", 6.0}, {"cy_px", -9.0}}),
      EffectOn("lens_distortion", {{"k1", 0.08}}),
      EffectOn("warm_up_drift", {{"amplitude_m", 0.006}, {"tau_s", 50.0}})};
  VirtualCamera taker(bench.scenario, bench.surface, effects, 4);
  rgbd::RgbdFrame frame;
  taker.Take(bench.view, &frame);
  const CameraFaults faults = FaultsFrom(effects, 4);
  const rgbd::CameraModel true_camera = faults.TrueDepthCamera(camera.depth);
  Eigen::Vector3d normal(-std::sin(kTilt_rad), 0.0, std::cos(kTilt_rad));
  int compared = 0;
  for (int u = 200; u < 640; u += 60) {
    for (const int v : {90, 240, 400}) {
      const double z_m = static_cast<double>(*taker.true_range().Pixel(u, v));
      if (!(z_m < 0.8)) continue;
      const Eigen::Vector3d point_m = z_m * rgbd::Unproject(true_camera, {u, v});
      if (normal.dot(point_m) > 0.0) normal *= -1.0;  // outward is towards the camera
      const Eigen::Vector3d wanted_m =
          DepthAt(frame, bench.scenario, u, v) * rgbd::Unproject(camera.depth, {u, v});
      const Eigen::Vector3d measured_m =
          MeasurePoints(faults, camera.depth, kTime_s, point_m, normal);
      EXPECT_LT((measured_m - wanted_m).norm(), 2e-5) << u << ", " << v;
      EXPECT_GT((measured_m - point_m).norm(), 5e-3);
      ++compared;
    }
  }
  EXPECT_GT(compared, 15);
}

TEST(MeasuredPoints, AreWithinThePictureAndBeforeTheCamera) {
  const rgbd::CameraModel camera{.width_px = 100,
                                 .height_px = 80,
                                 .fx_px = 100.0,
                                 .fy_px = 100.0,
                                 .cx_px = 50.0,
                                 .cy_px = 40.0};
  Eigen::Matrix3Xd points_m(3, 3);
  points_m << 0.1, 0.6, 0.1,  //
      0.1, 0.0, 0.1,          //
      1.0, 1.0, -1.0;
  Eigen::Matrix3Xd normals(3, 3);
  normals.colwise() = -Eigen::Vector3d::UnitZ();
  const Eigen::Matrix3Xd measured_m = MeasurePoints({}, camera, 0.0, points_m, normals);
  EXPECT_LT((measured_m.col(0) - points_m.col(0)).norm(), 1e-12);
  EXPECT_TRUE(measured_m.rightCols(2).array().isNaN().all());
}

}  // namespace
}  // namespace palpate::virtual_camera
