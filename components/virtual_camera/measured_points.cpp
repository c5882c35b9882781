// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_camera/measured_points.hpp"

#include <algorithm>
#include <limits>

namespace palpate::virtual_camera {

namespace {

/// As in the images (kernels/depth_rows.inl).
constexpr double kLeastCosine = 0.25;

bool IsInPicture(const rgbd::CameraModel& camera, const Eigen::Vector2d& pixel_px) {
  return pixel_px.x() > -0.5 && pixel_px.x() < camera.width_px - 0.5 && pixel_px.y() > -0.5 &&
         pixel_px.y() < camera.height_px - 0.5;
}

}  // namespace

Eigen::Matrix3Xd MeasurePoints(const CameraFaults& faults, const rgbd::CameraModel& data_sheet,
                               double t_s, const Eigen::Matrix3Xd& points_m,
                               const Eigen::Matrix3Xd& normals) {
  const rgbd::CameraModel true_camera = faults.TrueDepthCamera(data_sheet);
  Eigen::Matrix3Xd measured_m =
      Eigen::Matrix3Xd::Constant(3, points_m.cols(), std::numeric_limits<double>::quiet_NaN());
  for (Eigen::Index k = 0; k < points_m.cols(); ++k) {
    const Eigen::Vector3d point_m = points_m.col(k);
    if (point_m.z() <= 0.0) continue;
    const Eigen::Vector2d pixel_px = rgbd::Project(true_camera, point_m);
    if (!IsInPicture(data_sheet, pixel_px)) continue;
    const Eigen::Vector3d ray = point_m.normalized();
    const double cosine = std::max(kLeastCosine, -normals.col(k).dot(ray));
    const double farther_m = faults.incidence_bias_m * (1.0 / cosine - 1.0);
    const double z_m =
        (1.0 + faults.depth_scale) * point_m.z() + faults.DriftAt(t_s) + farther_m * ray.z();
    measured_m.col(k) = z_m * rgbd::Unproject(data_sheet, pixel_px);
  }
  return measured_m;
}

}  // namespace palpate::virtual_camera
