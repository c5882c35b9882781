// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "components/force_estimation/shape/shape_frame.hpp"
#include "components/force_estimation/shape/surface_matching.hpp"
#include "libs/correspondence/surface_features.hpp"
#include "libs/rgbd/camera_model.hpp"
#include "libs/rgbd/surface_view.hpp"
#include "libs/robot/robot_body.hpp"
#include "libs/robot/robot_model.hpp"
#include "tests/support/robots.hpp"

namespace palpate::force_estimation {

/// The four-legged robot of config/robots before the depth camera of config/scenarios/pushes.yaml.
/// Its shapes are made by moving its nodes; nothing is solved.
struct ShapeScene {
  explicit ShapeScene(int feature_points) {
    robot::RobotDescription robot = test_support::FourLegRobot();
    robot.feature_point_count = feature_points;
    model = std::make_unique<robot::RobotModel>(robot::BuildRobotBody(robot));
    features = std::make_unique<correspondence::SurfaceFeatures>(model->body());
    const Eigen::Matrix3Xd& nodes_m = model->body().mesh.nodes_m;
    rest_x_m = Eigen::Map<const Eigen::VectorXd>(nodes_m.data(), nodes_m.size());
  }

  std::unique_ptr<robot::RobotModel> model;
  std::unique_ptr<correspondence::SurfaceFeatures> features;
  Eigen::VectorXd rest_x_m;  ///< [3n]
};

/// With the robot file's 51 feature points; made once.
inline const ShapeScene& FourLegScene() {
  static const ShapeScene scene(51);
  return scene;
}

inline rgbd::CameraModel BenchDepthCamera() {
  return {.width_px = 848,
          .height_px = 480,
          .fx_px = 425.0,
          .fy_px = 425.0,
          .cx_px = 423.5,
          .cy_px = 239.5};
}

/// A camera at `eye_m` that looks at `target_m`, its y axis down.
inline Eigen::Isometry3d LookAt(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& target_m) {
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d z = (target_m - eye_m).normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  T_robot_camera.linear() << x, z.cross(x), z;
  T_robot_camera.translation() = eye_m;
  return T_robot_camera;
}

inline Eigen::Isometry3d BenchPose() { return LookAt({0.343, -0.198, 0.275}, {0.0, 0.0, 0.065}); }

/// The nodes moved by `motion` (position to displacement, m).
template <typename Motion>
Eigen::VectorXd Moved(const Eigen::VectorXd& x_m, const Motion& motion) {
  Eigen::VectorXd moved_m = x_m;
  for (Eigen::Index k = 0; k < x_m.size(); k += 3) {
    moved_m.segment<3>(k) += motion(Eigen::Vector3d(x_m.segment<3>(k)));
  }
  return moved_m;
}

/// Bends and stretches by some millimetres, most at the top.
inline Eigen::Vector3d Bend(const Eigen::Vector3d& rest_m) {
  const double height = rest_m.z() / 0.12;
  return {4e-3 * height * height, -3e-3 * height * height,
          2e-3 * height * std::sin(20.0 * rest_m.x())};
}

inline Eigen::VectorXd Shifted(const Eigen::VectorXd& x_m, const Eigen::Vector3d& by_m) {
  return Moved(x_m, [&](const Eigen::Vector3d&) { return by_m; });
}

/// Exact depth of the surface at every `step_px`-th pixel, robot at `x_m`.
inline rgbd::SensedCloud Cast(const ShapeScene& scene, const Eigen::VectorXd& x_m,
                              const Eigen::Isometry3d& T_robot_camera, int step_px = 3,
                              float sigma_m = 3e-4f) {
  const rgbd::CameraModel camera = BenchDepthCamera();
  const Eigen::Map<const Eigen::Matrix3Xd> nodes_m(x_m.data(), 3, x_m.size() / 3);
  rgbd::SurfaceView view(camera);
  view.Look(T_robot_camera.inverse() * nodes_m, scene.features->triangles());
  std::vector<Eigen::Vector3f> points_m;
  for (int v = 0; v < camera.height_px; v += step_px) {
    for (int u = 0; u < camera.width_px; u += step_px) {
      if (view.Triangle(u, v) == rgbd::SurfaceView::kNothing) continue;
      const Eigen::Vector3d direction = rgbd::Unproject(camera, {u, v});
      points_m.emplace_back(direction.cast<float>() * view.Z_m(u, v));
    }
  }
  rgbd::SensedCloud cloud;
  cloud.points_m.resize(3, static_cast<Eigen::Index>(points_m.size()));
  for (size_t k = 0; k < points_m.size(); ++k) {
    cloud.points_m.col(static_cast<Eigen::Index>(k)) = points_m[k];
  }
  cloud.sigma_m.setConstant(cloud.points_m.cols(), sigma_m);
  cloud.colors_rgb.assign(3 * points_m.size(), 128);
  return cloud;
}

/// Each point goes along its line of sight, independent of all others.
inline void AddDepthNoise(std::mt19937& random, rgbd::SensedCloud* cloud, float scale = 1.0f) {
  std::normal_distribution<float> normal(0.0f, 1.0f);
  for (Eigen::Index k = 0; k < cloud->Count(); ++k) {
    const float z_m = cloud->points_m(2, k);
    cloud->points_m.col(k) *= 1.0f + scale * cloud->sigma_m[k] * normal(random) / z_m;
  }
}

inline double Residual_m(const correspondence::FeatureMatch& match, const Eigen::VectorXd& x_m) {
  return match.target_m - match.row.Value(x_m);
}

inline ShapeFrame FrameOf(const rgbd::SensedCloud& cloud,
                          const Eigen::Isometry3d& T_robot_camera = BenchPose()) {
  ShapeFrame frame;
  frame.views[0] = {cloud, T_robot_camera};
  return frame;
}

}  // namespace palpate::force_estimation
