// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/picture/camera.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "libs/core/check.hpp"

namespace palpate::view {

namespace {

struct Bounds {
  Eigen::Array2d lower = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array2d upper = -lower;

  void Add(const Eigen::Array2d& point, double radius) {
    lower = lower.min(point - radius);
    upper = upper.max(point + radius);
  }
};

Extent EnclosingBall(const std::vector<Extent>& extents) {
  Eigen::Array3d lower = extents.front().center_m.array();
  Eigen::Array3d upper = lower;
  for (const Extent& extent : extents) {
    lower = lower.min(extent.center_m.array() - extent.radius_m);
    upper = upper.max(extent.center_m.array() + extent.radius_m);
  }
  const double half_diagonal_m = 0.5 * (upper - lower).matrix().norm();
  return {(0.5 * (lower + upper)).matrix(), std::max(half_diagonal_m, 1e-9)};
}

}  // namespace

Camera Camera::Fit(const ViewDirection& view, const std::vector<Extent>& extents,
                   const Rect& area) {
  PALPATE_CHECK(!extents.empty());
  PALPATE_CHECK(std::abs(view.elevation_deg) < 90.0, view.elevation_deg);
  const double azimuth = view.azimuth_deg * std::numbers::pi / 180.0;
  const double elevation = view.elevation_deg * std::numbers::pi / 180.0;
  Camera camera;
  camera.toward_ = {std::cos(elevation) * std::cos(azimuth),
                    std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
  camera.right_ = {-std::sin(azimuth), std::cos(azimuth), 0.0};
  camera.up_ = camera.toward_.cross(camera.right_);
  const Extent ball = EnclosingBall(extents);
  camera.target_m_ = ball.center_m;
  camera.eye_distance_m_ = std::max(view.eye_distance_radii, 0.0) * ball.radius_m;
  PALPATE_CHECK(view.eye_distance_radii <= 0.0 || view.eye_distance_radii > 1.0,
                view.eye_distance_radii);

  Bounds bounds;
  for (const Extent& extent : extents) {
    const Eigen::Vector3d seen = camera.Project(extent.center_m);
    const double depth_m = camera.toward_.dot(extent.center_m - camera.target_m_);
    const double nearest_m = camera.eye_distance_m_ - depth_m - extent.radius_m;
    const double magnification =
        camera.orthographic() ? 1.0 : camera.eye_distance_m_ / std::max(nearest_m, 1e-9);
    bounds.Add(seen.head<2>().array(), extent.radius_m * magnification);
  }
  const Eigen::Array2d size = (bounds.upper - bounds.lower).max(1e-9);
  camera.px_per_m_ = std::min(area.width_px / size.x(), area.height_px / size.y());
  const Eigen::Vector2d middle = (0.5 * (bounds.lower + bounds.upper)).matrix();
  camera.origin_px_ =
      Eigen::Vector2d(area.x_px + 0.5 * area.width_px, area.y_px + 0.5 * area.height_px) -
      camera.px_per_m_ * middle;
  return camera;
}

Eigen::Vector3d Camera::Project(const Eigen::Vector3d& point_m) const {
  const Eigen::Vector3d offset = point_m - target_m_;
  const double depth_m = toward_.dot(offset);
  double magnification = 1.0;
  double nearness = depth_m;
  if (!orthographic()) {
    // 1/distance is what stays linear over a plane under perspective.
    const double distance_m = std::max(eye_distance_m_ - depth_m, 1e-9);
    magnification = eye_distance_m_ / distance_m;
    nearness = eye_distance_m_ * magnification;
  }
  const double scale = px_per_m_ * magnification;
  return {origin_px_.x() + scale * right_.dot(offset), origin_px_.y() - scale * up_.dot(offset),
          nearness};
}

Eigen::Vector3d Camera::TowardViewer(const Eigen::Vector3d& point_m) const {
  if (orthographic()) {
    return toward_;
  }
  return (target_m_ + eye_distance_m_ * toward_ - point_m).normalized();
}

}  // namespace palpate::view
