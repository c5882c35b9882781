// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>

#include "libs/geometry/depth_picture.hpp"

namespace palpate::rgbd {

/// k1, k2, p1, p2, k3, k4, k5, k6: OpenCV's order.
using Distortion = std::array<double, 8>;

/// A pinhole camera with OpenCV's rational lens distortion ("rational_polynomial" in ROS); with
/// k4 = k5 = k6 = 0 it is that of Brown and Conrady ("plumb_bob"). A point (x, y, 1) of the
/// normalised image goes to
///   x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6)
///        + 2 p1 x y + p2 (r^2 + 2 x^2), y' likewise,
///   u = fx x' + cx, v = fy y' + cy.
/// Optical frame: x right, y down, z forward. Pixel (0, 0) has its centre at u = v = 0.
struct CameraModel {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
  Distortion distortion{};

  bool distorted() const { return distortion != Distortion{}; }
  /// Whether k4, k5 or k6 is not 0.
  bool rational() const {
    return distortion[5] != 0.0 || distortion[6] != 0.0 || distortion[7] != 0.0;
  }
  /// Five numbers, of a rational lens eight: as files and messages have them.
  std::span<const double> coefficients() const {
    constexpr std::size_t kWithoutDenominator = 5;
    return {distortion.data(), rational() ? distortion.size() : kWithoutDenominator};
  }
  bool operator==(const CameraModel&) const = default;
};

geometry::DepthPicture PictureOf(const CameraModel& camera);

/// Where a point (camera frame, m, z > 0) is seen, px.
Eigen::Vector2d Project(const CameraModel& camera, const Eigen::Vector3d& point_m);

/// The direction (x, y, 1) that is seen at a pixel: Project's inverse, to 1e-10 where the
/// distortion can be inverted there; NaN where it cannot.
Eigen::Vector3d Unproject(const CameraModel& camera, const Eigen::Vector2d& pixel_px);

}  // namespace palpate::rgbd
