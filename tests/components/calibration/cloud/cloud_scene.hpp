// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "components/calibration/cloud/cloud_frame.hpp"
#include "components/calibration/cloud/surface_errors.hpp"
#include "libs/rgbd/surface_view.hpp"
#include "tests/components/calibration/joint/joint_scene.hpp"

namespace palpate::calibration {

/// The camera of config/scenarios/pushes.yaml, at half its resolution.
inline const rgbd::CameraModel kCamera{.width_px = 424,
                                       .height_px = 240,
                                       .fx_px = 212.5,
                                       .fy_px = 212.5,
                                       .cx_px = 211.5,
                                       .cy_px = 119.5};
inline constexpr double kDegree = std::numbers::pi / 180.0;  ///< in radians
inline constexpr double kDepthSigma_m = 0.8e-3;

/// The model's surface is the robot's.
inline SurfaceErrorSettings NoSurfaceErrors() {
  return {.whole_sigma_m = 0.0,
          .patch_sigma_m = 0.0,
          .region_sigma_m = 0.0,
          .motion_sigma = 0.0,
          .region_motion_sigma = 0.0};
}

/// From `eye_m` towards `target_m`, robot frame; x of the picture level.
inline geometry::RigidTransform LookAt(const Eigen::Vector3d& eye_m,
                                       const Eigen::Vector3d& target_m) {
  Eigen::Matrix3d R;
  R.col(2) = (target_m - eye_m).normalized();
  R.col(0) = R.col(2).cross(Eigen::Vector3d::UnitZ()).normalized();
  R.col(1) = R.col(2).cross(R.col(0));
  return {R, eye_m};
}

inline geometry::RigidTransform TruePose() {
  return LookAt({0.343, -0.198, 0.275}, {0.0, 0.0, 0.065});
}

/// Off by `turn_rad` about, and `shift_m` along, directions drawn at random; the turn is about the
/// robot's middle, so that shift and turn are what the picture is off by.
inline geometry::RigidTransform OffBy(const geometry::RigidTransform& T, double turn_rad,
                                      double shift_m, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const auto direction = [&] {
    const double x = normal(random);
    const double y = normal(random);
    return Eigen::Vector3d(x, y, normal(random)).normalized();
  };
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(turn_rad, direction()));
  const Eigen::Vector3d middle_m(0.0, 0.0, 0.065);
  return {turn * T.rotation(),
          middle_m + turn * (T.translation_m() - middle_m) + shift_m * direction()};
}

/// Points of other things: a ball before the hub and a plate under the feet, and some anywhere.
inline Eigen::Vector3d OtherThing(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const double kind = unit(random);
  const Eigen::Vector3d a(unit(random), unit(random), unit(random));
  if (kind < -0.2) return Eigen::Vector3d(0.07, -0.05, 0.13) + 0.02 * a.normalized();
  if (kind < 0.7) return {0.18 * a.x(), 0.18 * a.y(), -0.002};
  return Eigen::Vector3d(0.0, 0.0, 0.08) + 0.15 * a;
}

/// What a depth camera at `T_robot_camera` sees of the robot in this state, with noise of z that is
/// independent from pixel to pixel, and `others` as share of all points that are not the robot.
inline rgbd::SensedCloud Render(const robot::RobotModel& model, const fem::StaticState& state,
                                const geometry::RigidTransform& T_robot_camera, double others,
                                std::mt19937_64& random, double sigma_m = kDepthSigma_m) {
  const auto nodes = Eigen::Map<const Eigen::Matrix3Xd>(state.x_m.data(), 3, state.x_m.size() / 3);
  rgbd::SurfaceView view(kCamera);
  view.Look(T_robot_camera.Inverse().Apply(nodes), model.body().boundary.DrawnTriangles());
  std::normal_distribution<double> noise(0.0, sigma_m);
  std::vector<Eigen::Vector3d> points_m;
  for (int v = 0; v < kCamera.height_px; ++v) {
    for (int u = 0; u < kCamera.width_px; ++u) {
      if (view.Triangle(u, v) == rgbd::SurfaceView::kNothing) continue;
      const double z_m = static_cast<double>(view.Z_m(u, v)) + noise(random);
      points_m.emplace_back(z_m * rgbd::Unproject(kCamera, Eigen::Vector2d(u, v)));
    }
  }
  const double more = others / (1.0 - others) * static_cast<double>(points_m.size());
  for (int k = 0; k < static_cast<int>(more); ++k) {
    points_m.emplace_back(T_robot_camera.Inverse() * OtherThing(random));
  }
  rgbd::SensedCloud cloud;
  const auto count = static_cast<Eigen::Index>(points_m.size());
  cloud.points_m.resize(3, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    cloud.points_m.col(k) = points_m[static_cast<size_t>(k)].cast<float>();
  }
  cloud.sigma_m.setConstant(count, static_cast<float>(sigma_m));
  return cloud;
}

/// `told_m`: what the actuators say that the cables were pulled in by; `truth_m`: what they were.
inline CloudFrame SeeCloud(robot::RobotModel& truth, const geometry::RigidTransform& T_robot_camera,
                           const std::string& name, const std::vector<double>& told_m,
                           const std::vector<double>& truth_m, double others,
                           std::mt19937_64& random, double sigma_m = kDepthSigma_m) {
  const fem::StaticState state =
      force_estimation::SolveTruth(truth, Commands(Kind::kDisplacement, truth_m), {});
  return {.name = name,
          .cloud = Render(truth, state, T_robot_camera, others, random, sigma_m),
          .cables = Commands(Kind::kDisplacement, told_m),
          .gravity_m_s2 = truth.gravity_m_s2()};
}

}  // namespace palpate::calibration
