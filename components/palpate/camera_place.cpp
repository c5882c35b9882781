// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/camera_place.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "libs/geometry/pose_text.hpp"

namespace palpate::command {

Eigen::Vector3d ViewDirection(const Eigen::Vector3d& longest_axis, const Eigen::Vector3d& up,
                              const Eigen::Vector3d& to_tip_m) {
  Eigen::Vector3d side = longest_axis.cross(up);
  if (side.norm() < 0.3) side = up.unitOrthogonal();
  Eigen::Vector3d to_tip = to_tip_m - to_tip_m.dot(up) * up;
  const double length_m = to_tip.norm();
  if (length_m > 0.0) to_tip /= length_m;
  return (side.normalized() + 0.45 * up + 0.25 * to_tip).normalized();
}

Eigen::Isometry3d CameraPlace(const geometry::Box& box, const Eigen::Vector3d& view,
                              const Eigen::Vector3d& up) {
  // The lens sees the diagonal from 1.5 of it; nearer than 0.25 m stereo cameras see nothing.
  constexpr double kDiagonals = 1.5, kNearest_m = 0.25;
  const double distance_m = std::max(kNearest_m, kDiagonals * box.Diagonal_m());
  // Camera axes: x to the right, y down, z forward.
  const Eigen::Vector3d right = up.cross(view).normalized();
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
  T_robot_camera.linear() << right, right.cross(view), -view;
  T_robot_camera.translation() = 0.5 * (box.lower_m + box.upper_m) + distance_m * view;
  return T_robot_camera;
}

std::string StereoCameraText(const Eigen::Isometry3d& T_robot_camera, double rate_hz) {
  const std::string image =
      "    width_px: 848\n    height_px: 480\n    fx_px: 425\n"
      "    fy_px: 425\n    cx_px: 423.5\n    cy_px: 239.5\n";
  return "camera:\n  depth:\n" + image + "    unit_m: 0.0001\n    baseline_m: 0.05\n" +
         "  color:\n" + image + "    registered_to_depth: true\n" +
         "  T_robot_camera: " + geometry::FormatPose(T_robot_camera) +
         fmt::format("\n  rate_hz: {:g}\n  noise: {{sensor: stereo}}\n", rate_hz);
}

}  // namespace palpate::command
