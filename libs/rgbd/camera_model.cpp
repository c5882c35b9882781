// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/rgbd/camera_model.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <limits>

namespace palpate::rgbd {

namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

/// Largest error of the inverse, in the normalised image (1e-10 is promised).
constexpr double kTolerance = 1e-12;
constexpr int kMaxIterations = 50;
constexpr int kMaxHalvings = 30;
/// Points between the image centre and the solution at which the distortion must not have folded.
constexpr int kFoldChecks = 16;

struct Radial {
  double scale = 1.0;       ///< (1 + k1 s + k2 s^2 + k3 s^3) / (1 + k4 s + ...) with s = r^2
  double derivative = 0.0;  ///< of it, by s
};

Radial RadialAt(const CameraModel& camera, double s) {
  const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = camera.distortion;
  const Radial above{1.0 + s * (k1 + s * (k2 + s * k3)), k1 + s * (2.0 * k2 + s * 3.0 * k3)};
  if (!camera.rational()) return above;
  const Radial below{1.0 + s * (k4 + s * (k5 + s * k6)), k4 + s * (2.0 * k5 + s * 3.0 * k6)};
  const double scale = above.scale / below.scale;
  return {scale, (above.derivative - scale * below.derivative) / below.scale};
}

Vector2d Distort(const CameraModel& camera, const Vector2d& point) {
  const double x = point.x(), y = point.y();
  const double p1 = camera.distortion[2], p2 = camera.distortion[3];
  const double s = point.squaredNorm();
  return RadialAt(camera, s).scale * point + Vector2d(2.0 * p1 * x * y + p2 * (s + 2.0 * x * x),
                                                      p1 * (s + 2.0 * y * y) + 2.0 * p2 * x * y);
}

/// Derivative of Distort.
Matrix2d Jacobian(const CameraModel& camera, const Vector2d& point) {
  const double x = point.x(), y = point.y();
  const double p1 = camera.distortion[2], p2 = camera.distortion[3];
  const Radial radial = RadialAt(camera, point.squaredNorm());
  Matrix2d J =
      radial.scale * Matrix2d::Identity() + 2.0 * radial.derivative * point * point.transpose();
  J(0, 0) += 2.0 * p1 * y + 6.0 * p2 * x;
  J(0, 1) += 2.0 * p1 * x + 2.0 * p2 * y;
  J(1, 0) += 2.0 * p1 * x + 2.0 * p2 * y;
  J(1, 1) += 6.0 * p1 * y + 2.0 * p2 * x;
  return J;
}

/// Far from the centre a polynomial turns back, and two directions would be seen at one pixel: only
/// the solution on the centre's side of that fold is the camera's.
bool FoldsBefore(const CameraModel& camera, const Vector2d& point) {
  for (int i = 1; i <= kFoldChecks; ++i) {
    const Matrix2d J = Jacobian(camera, point * (static_cast<double>(i) / kFoldChecks));
    if (!(J.determinant() > 0.0 && J.trace() > 0.0)) return true;
  }
  return false;
}

/// One Newton step, halved until it comes nearer. False where no step does.
bool Improve(const CameraModel& camera, const Vector2d& wanted, Vector2d* point, double* error) {
  const Matrix2d J = Jacobian(camera, *point);
  if (std::abs(J.determinant()) < std::numeric_limits<double>::min()) return false;
  Vector2d step = J.inverse() * (wanted - Distort(camera, *point));
  for (int i = 0; i < kMaxHalvings; ++i, step *= 0.5) {
    const double new_error = (wanted - Distort(camera, *point + step)).norm();
    if (new_error < *error) {
      *point += step;
      *error = new_error;
      return true;
    }
  }
  return false;
}

/// Distort's inverse by Newton's method from the distorted point; NaN where there is none.
Vector2d Undistort(const CameraModel& camera, const Vector2d& wanted) {
  Vector2d point = wanted;
  double error = (wanted - Distort(camera, point)).norm();
  for (int i = 0; i < kMaxIterations && error > 0.0; ++i) {
    if (!Improve(camera, wanted, &point, &error)) break;
  }
  const double size = 1.0 + wanted.norm();
  if (!(error <= kTolerance * size) || FoldsBefore(camera, point)) {
    return Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  }
  return point;
}

}  // namespace

geometry::DepthPicture PictureOf(const CameraModel& camera) {
  return {.width_px = camera.width_px,
          .height_px = camera.height_px,
          .fx_px = camera.fx_px,
          .fy_px = camera.fy_px,
          .cx_px = camera.cx_px,
          .cy_px = camera.cy_px};
}

Vector2d Project(const CameraModel& camera, const Eigen::Vector3d& point_m) {
  Vector2d point = point_m.head<2>() / point_m.z();
  if (camera.distorted()) point = Distort(camera, point);
  return {camera.fx_px * point.x() + camera.cx_px, camera.fy_px * point.y() + camera.cy_px};
}

Eigen::Vector3d Unproject(const CameraModel& camera, const Vector2d& pixel_px) {
  Vector2d point((pixel_px.x() - camera.cx_px) / camera.fx_px,
                 (pixel_px.y() - camera.cy_px) / camera.fy_px);
  if (camera.distorted()) point = Undistort(camera, point);
  return point.homogeneous();
}

}  // namespace palpate::rgbd
