// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/components/perception/contact_scene.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace palpate::perception::test {

namespace {

/// Distance along the ray to the ball, or infinity.
double HitBall(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& ray,
               const Eigen::Vector3d& center_m, double radius_m) {
  const Eigen::Vector3d off_m = eye_m - center_m;
  const double b = off_m.dot(ray);
  const double root = b * b - off_m.squaredNorm() + radius_m * radius_m;
  return root < 0.0 ? std::numeric_limits<double>::infinity() : -b - std::sqrt(root);
}

/// Distance along the ray to the side of an upright post on the plate, or infinity.
double HitPost(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& ray,
               const Eigen::Vector2d& foot_m, const BallsOnPlate& scene) {
  const Eigen::Vector2d off_m = eye_m.head<2>() - foot_m;
  const double a = ray.head<2>().squaredNorm();
  const double b = off_m.dot(ray.head<2>());
  const double root = b * b - a * (off_m.squaredNorm() - scene.radius_m * scene.radius_m);
  if (root < 0.0) return std::numeric_limits<double>::infinity();
  const double distance_m = (-b - std::sqrt(root)) / a;
  const double height_m = eye_m.z() + distance_m * ray.z();
  const bool hit = height_m >= scene.gap_m && height_m <= scene.gap_m + scene.post_height_m;
  return hit ? distance_m : std::numeric_limits<double>::infinity();
}

/// To the nearest of the objects.
double HitObject(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& ray,
                 const BallsOnPlate& scene) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& touch : scene.touch_m) {
    const Eigen::Vector3d center_m(touch.x(), touch.y(), scene.gap_m + scene.radius_m);
    const double hit_m = scene.post_height_m > 0.0 ? HitPost(eye_m, ray, touch, scene)
                                                   : HitBall(eye_m, ray, center_m, scene.radius_m);
    nearest_m = std::min(nearest_m, hit_m);
  }
  return nearest_m;
}

double HitPlate(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& ray, double half_m) {
  const double distance_m = -eye_m.z() / ray.z();
  const Eigen::Vector3d at_m = eye_m + distance_m * ray;
  const bool hit = distance_m > 0.0 && std::max(std::abs(at_m.x()), std::abs(at_m.y())) <= half_m;
  return hit ? distance_m : std::numeric_limits<double>::infinity();
}

Eigen::Isometry3d PoseOf(const ContactView& view) {
  Eigen::Isometry3d T_plate_camera = Eigen::Isometry3d::Identity();
  T_plate_camera.rotate(
      Eigen::AngleAxisd(view.turn_rad, Eigen::Vector3d::UnitZ()) *
      Eigen::AngleAxisd(std::numbers::pi - view.tilt_rad, Eigen::Vector3d::UnitX()));
  T_plate_camera.translate(Eigen::Vector3d(0.0, 0.0, -view.distance_m));
  return T_plate_camera;
}

}  // namespace

PredictedSurface PlateSeenBy(const ContactView& view, double plate_half_m) {
  constexpr double kThick_m = 0.02;
  const double h = plate_half_m;
  Eigen::Matrix3Xd corners_m(3, 8);
  corners_m << -h, h, h, -h, -h, h, h, -h,  //
      -h, -h, h, h, -h, -h, h, h,           //
      0, 0, 0, 0, -kThick_m, -kThick_m, -kThick_m, -kThick_m;
  PredictedSurface surface;
  surface.vertices_m = PoseOf(view).inverse() * corners_m;
  surface.triangles.resize(3, 4);
  surface.triangles << 0, 0, 4, 4,  //
      1, 2, 6, 7,                   //
      2, 3, 5, 6;
  return surface;
}

rgbd::SensedCloud CloudOf(const std::vector<Eigen::Vector3d>& points_m, double sigma_m) {
  rgbd::SensedCloud cloud;
  const auto count = static_cast<Eigen::Index>(points_m.size());
  cloud.points_m.resize(3, count);
  cloud.sigma_m.setConstant(count, static_cast<float>(sigma_m));
  cloud.colors_rgb.assign(3 * points_m.size(), 128);
  for (Eigen::Index i = 0; i < count; ++i) {
    cloud.points_m.col(i) = points_m[static_cast<std::size_t>(i)].cast<float>();
  }
  return cloud;
}

Clouds SampleAll(const BallsOnPlate& scene, double spacing_m, double distance_m) {
  const auto to_camera = [&](double x, double y, double z) {
    return Eigen::Vector3d(x, -y, distance_m - z);
  };
  std::vector<Eigen::Vector3d> robot;
  const int half = static_cast<int>(scene.plate_half_m / spacing_m);
  for (int i = -half; i <= half; ++i) {
    for (int j = -half; j <= half; ++j) robot.push_back(to_camera(i * spacing_m, j * spacing_m, 0));
  }
  std::vector<Eigen::Vector3d> object;
  for (const Eigen::Vector2d& touch : scene.touch_m) {
    // Spiral of Fibonacci over the lower half: equal areas, no direction preferred.
    const double area_m2 = 2.0 * std::numbers::pi * scene.radius_m * scene.radius_m;
    const int count = static_cast<int>(area_m2 / (spacing_m * spacing_m));
    for (int k = 0; k < count; ++k) {
      const double height = (k + 0.5) / count;
      const double turn = k * std::numbers::pi * (3.0 - std::sqrt(5.0));
      const double out_m = scene.radius_m * std::sqrt(1.0 - (1.0 - height) * (1.0 - height));
      object.push_back(to_camera(touch.x() + out_m * std::cos(turn),
                                 touch.y() + out_m * std::sin(turn),
                                 scene.gap_m + scene.radius_m * height));
    }
  }
  return {CloudOf(robot, 1e-5), CloudOf(object, 1e-5)};
}

Clouds Look(const BallsOnPlate& scene, const ContactView& view, std::mt19937* random,
            std::vector<Eigen::Vector3d>* touch_camera_m) {
  const Eigen::Isometry3d T_plate_camera = PoseOf(view);
  const Eigen::Vector3d eye_m = T_plate_camera.translation();
  std::normal_distribution<double> noise_m(0.0, view.sigma_m);
  std::vector<Eigen::Vector3d> robot;
  std::vector<Eigen::Vector3d> object;
  const int half = static_cast<int>(1.5 * scene.plate_half_m / view.spacing_m);
  for (int v = -half; v <= half; ++v) {
    for (int u = -half; u <= half; ++u) {
      const Eigen::Vector3d along =
          Eigen::Vector3d(u * view.spacing_m, v * view.spacing_m, view.distance_m).normalized();
      const Eigen::Vector3d ray = T_plate_camera.linear() * along;
      const double plate_m = HitPlate(eye_m, ray, scene.plate_half_m);
      const double object_m = HitObject(eye_m, ray, scene);
      const double nearest_m = std::min(plate_m, object_m);
      if (!std::isfinite(nearest_m)) continue;
      const double error = 1.0 + noise_m(*random) / (nearest_m * along.z());
      (object_m < plate_m ? object : robot).push_back(along * nearest_m * error);
    }
  }
  touch_camera_m->clear();
  for (const Eigen::Vector2d& touch : scene.touch_m) {
    touch_camera_m->push_back(T_plate_camera.inverse() *
                              Eigen::Vector3d(touch.x(), touch.y(), 0.0));
  }
  return {CloudOf(robot, view.sigma_m), CloudOf(object, view.sigma_m)};
}

}  // namespace palpate::perception::test
