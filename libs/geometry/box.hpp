// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

namespace palpate::geometry {

/// Axis-aligned box, bounds included.
struct Box {
  Eigen::Vector3d lower_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d upper_m = Eigen::Vector3d::Zero();

  bool Contains(const Eigen::Vector3d& point_m) const {
    return (point_m.array() >= lower_m.array()).all() && (point_m.array() <= upper_m.array()).all();
  }

  double Diagonal_m() const { return (upper_m - lower_m).norm(); }

  /// 0 inside.
  double SquaredDistance_m2(const Eigen::Vector3d& point_m) const {
    const Eigen::Vector3d nearest_m = point_m.cwiseMax(lower_m).cwiseMin(upper_m);
    return (nearest_m - point_m).squaredNorm();
  }
};

/// The smallest box that holds all of `points_m` [3 x n], n >= 1.
inline Box BoundingBox(const Eigen::Ref<const Eigen::Matrix3Xd>& points_m) {
  return {points_m.rowwise().minCoeff(), points_m.rowwise().maxCoeff()};
}

}  // namespace palpate::geometry
