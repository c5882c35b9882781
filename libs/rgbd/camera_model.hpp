// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <array>

#include "libs/geometry/depth_picture.hpp"

namespace palpate::rgbd {

/// A pinhole camera with the lens distortion of Brown and Conrady ("plumb_bob" in ROS): a point
/// (x, y, 1) of the normalised image goes to
///   x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2), y' likewise,
///   u = fx x' + cx, v = fy y' + cy.
/// Optical frame: x right, y down, z forward. Pixel (0, 0) has its centre at u = v = 0.
struct CameraModel {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
  std::array<double, 5> distortion = {0.0, 0.0, 0.0, 0.0, 0.0};  ///< k1, k2, p1, p2, k3

  bool distorted() const { return distortion != std::array<double, 5>{}; }
  bool operator==(const CameraModel&) const = default;
};

geometry::DepthPicture PictureOf(const CameraModel& camera);

/// Where a point (camera frame, m, z > 0) is seen, px.
Eigen::Vector2d Project(const CameraModel& camera, const Eigen::Vector3d& point_m);

/// The direction (x, y, 1) that is seen at a pixel: Project's inverse, to 1e-10 where the
/// distortion can be inverted there; NaN where it cannot.
Eigen::Vector3d Unproject(const CameraModel& camera, const Eigen::Vector2d& pixel_px);

}  // namespace palpate::rgbd
