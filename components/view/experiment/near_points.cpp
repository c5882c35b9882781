// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/experiment/near_points.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "libs/core/index.hpp"

namespace palpate::view {

rgbd::SensedCloud NearPoints(const rgbd::DepthImage& depth, const rgbd::RgbdCamera& camera,
                             const Eigen::Isometry3d& T_robot_camera,
                             const Eigen::Matrix3Xd& nodes_m) {
  constexpr double kMostPoints = 30000.0;
  Eigen::AlignedBox3d room(nodes_m.rowwise().minCoeff(), nodes_m.rowwise().maxCoeff());
  const Eigen::Vector3d margin_m = Eigen::Vector3d::Constant(0.5 * room.diagonal().norm());
  room = Eigen::AlignedBox3d(room.min() - margin_m, room.max() + margin_m);
  const double pixels = static_cast<double>(depth.values.size());
  const int stride = std::max(1, static_cast<int>(std::ceil(std::sqrt(pixels / kMostPoints))));
  std::vector<Eigen::Vector3f> points_m;
  for (int v = 0; v < depth.height_px; v += stride) {
    for (int u = 0; u < depth.width_px; u += stride) {
      const int steps = *depth.Pixel(u, v);
      if (steps == camera.invalid_value || steps == 0) continue;
      const Eigen::Vector3d ray = rgbd::Unproject(camera.depth, Eigen::Vector2d(u, v));
      const Eigen::Vector3d point_m = T_robot_camera * (camera.depth_unit_m * steps * ray);
      if (room.contains(point_m)) points_m.push_back(point_m.cast<float>());
    }
  }
  rgbd::SensedCloud cloud;
  cloud.points_m.resize(3, ToIndex(points_m.size()));
  for (std::size_t k = 0; k < points_m.size(); ++k) cloud.points_m.col(ToIndex(k)) = points_m[k];
  return cloud;
}

}  // namespace palpate::view
