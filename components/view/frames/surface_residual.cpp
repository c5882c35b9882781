// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/frames/surface_residual.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::view {

namespace {

using Positions = Eigen::Map<const Eigen::Matrix3Xf>;

/// Normals of the nodes, as long as their triangles are large.
Eigen::Matrix3Xf NodeNormals(const Positions& nodes_m,
                             const std::vector<std::uint32_t>& triangles) {
  Eigen::Matrix3Xf normals = Eigen::Matrix3Xf::Zero(3, nodes_m.cols());
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    const Eigen::Vector3f a = nodes_m.col(triangles[t]);
    const Eigen::Vector3f normal =
        (nodes_m.col(triangles[t + 1]) - a).cross(nodes_m.col(triangles[t + 2]) - a);
    for (std::size_t k = 0; k < 3; ++k) normals.col(triangles[t + k]) += normal;
  }
  return normals;
}

/// Points sorted by the cube of space in which they lie, in a table of buckets.
class Grid {
 public:
  Grid(const Eigen::Matrix3Xf& points_m, float side_m)
      : points_m_(points_m), side_m_(side_m), mask_(BucketCount(points_m.cols()) - 1) {
    first_.assign(mask_ + 2, 0);
    for (Eigen::Index i = 0; i < points_m.cols(); ++i) ++first_[BucketOf(CubeOf(i)) + 1];
    for (std::size_t bucket = 1; bucket < first_.size(); ++bucket) {
      first_[bucket] += first_[bucket - 1];
    }
    order_.resize(static_cast<std::size_t>(points_m.cols()));
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (Eigen::Index i = 0; i < points_m.cols(); ++i) {
      order_[next[BucketOf(CubeOf(i))]++] = static_cast<std::uint32_t>(i);
    }
  }

  /// The nearest point within the side of a cube; -1: none.
  Eigen::Index Nearest(const Eigen::Vector3f& at_m) const {
    const Eigen::Vector3i cube = CubeAt(at_m);
    Eigen::Index nearest = -1;
    float best_m2 = side_m_ * side_m_;
    for (int step = 0; step < 27; ++step) {
      const Eigen::Vector3i neighbour =
          cube + Eigen::Vector3i(step % 3 - 1, step / 3 % 3 - 1, step / 9 - 1);
      const std::size_t bucket = BucketOf(neighbour);
      for (std::uint32_t k = first_[bucket]; k < first_[bucket + 1]; ++k) {
        const float distance_m2 = (points_m_.col(order_[k]) - at_m).squaredNorm();
        if (distance_m2 >= best_m2) continue;
        best_m2 = distance_m2;
        nearest = order_[k];
      }
    }
    return nearest;
  }

 private:
  static std::size_t BucketCount(Eigen::Index points) {
    std::size_t count = 64;
    while (count < static_cast<std::size_t>(points)) count *= 2;
    return count;
  }
  Eigen::Vector3i CubeAt(const Eigen::Vector3f& at_m) const {
    constexpr float kFarthest = 1e8F;  // what fits in an int
    return (at_m / side_m_).array().max(-kFarthest).min(kFarthest).floor().cast<int>();
  }
  Eigen::Vector3i CubeOf(Eigen::Index point) const { return CubeAt(points_m_.col(point)); }
  std::size_t BucketOf(const Eigen::Vector3i& cube) const {
    const auto hash = static_cast<std::uint32_t>(cube.x()) * 73856093U ^
                      static_cast<std::uint32_t>(cube.y()) * 19349663U ^
                      static_cast<std::uint32_t>(cube.z()) * 83492791U;
    return hash & mask_;
  }

  const Eigen::Matrix3Xf& points_m_;
  float side_m_;
  std::size_t mask_;
  std::vector<std::uint32_t> first_;  ///< [buckets + 1] of `order_`
  std::vector<std::uint32_t> order_;  ///< [k] points
};

}  // namespace

std::vector<float> SurfaceResidual(const std::vector<float>& positions_m,
                                   const std::vector<std::uint32_t>& triangles,
                                   const Eigen::Matrix3Xf& points_m, float radius_m) {
  const Positions nodes_m(positions_m.data(), 3, static_cast<Eigen::Index>(positions_m.size() / 3));
  std::vector<float> residual_m(positions_m.size() / 3, std::numeric_limits<float>::quiet_NaN());
  if (points_m.cols() == 0) return residual_m;
  const Eigen::Matrix3Xf normals = NodeNormals(nodes_m, triangles);
  const Grid grid(points_m, radius_m);
  for (Eigen::Index i = 0; i < nodes_m.cols(); ++i) {
    const Eigen::Index nearest = grid.Nearest(nodes_m.col(i));
    const float length = normals.col(i).norm();
    if (nearest < 0 || length <= 0.0F) continue;
    residual_m[static_cast<std::size_t>(i)] =
        normals.col(i).dot(points_m.col(nearest) - nodes_m.col(i)) / length;
  }
  return residual_m;
}

}  // namespace palpate::view
