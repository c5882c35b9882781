// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/correspondence/moving_surface.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "libs/core/index.hpp"
#include "libs/geometry/closest_point.hpp"

namespace palpate::correspondence {

namespace {

/// Triangles of some millimetres are crossed; a frame's motion is not more than some of them.
constexpr int kMostSteps = 24;
/// Cosine between the normals at a ridge (60 degrees).
constexpr double kSharp = 0.5;

/// The two triangles at an edge that more than two share count as not joined.
Eigen::Matrix3Xi FindBeyond(const Eigen::Matrix3Xi& triangles) {
  struct Side {
    int corner;
    int triangle;
  };
  std::map<std::pair<int, int>, std::vector<Side>> edges;
  for (int t = 0; t < static_cast<int>(triangles.cols()); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      const auto [low, high] =
          std::minmax(triangles((corner + 1) % 3, t), triangles((corner + 2) % 3, t));
      edges[{low, high}].push_back({corner, t});
    }
  }
  Eigen::Matrix3Xi beyond = Eigen::Matrix3Xi::Constant(3, triangles.cols(), -1);
  for (const auto& [edge, sides] : edges) {
    if (sides.size() != 2) continue;
    beyond(sides[0].corner, sides[0].triangle) = sides[1].triangle;
    beyond(sides[1].corner, sides[1].triangle) = sides[0].triangle;
  }
  return beyond;
}

/// Of the triangle's plane about its corner a.
struct Projection {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit; zero: no area
  Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();
  double height_m = 0.0;
};

Projection Project(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                   const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d ab = b - a;
  const Eigen::Vector3d ac = c - a;
  const Eigen::Vector3d from_a = point_m - a;
  const Eigen::Vector3d twice_area = ab.cross(ac);
  const double squared = twice_area.squaredNorm();
  if (!(squared > 0.0)) return {};
  const double share_b = from_a.cross(ac).dot(twice_area) / squared;
  const double share_c = ab.cross(from_a).dot(twice_area) / squared;
  const Eigen::Vector3d normal = twice_area / std::sqrt(squared);
  return {normal, {1.0 - share_b - share_c, share_b, share_c}, normal.dot(from_a)};
}

}  // namespace

MovingSurface::MovingSurface(const Eigen::Matrix3Xi& triangles)
    : nodes_(triangles.data(), triangles.data() + triangles.size()),
      triangles_(3, triangles.cols()) {
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  for (Eigen::Index k = 0; k < triangles.size(); ++k) {
    const auto at = std::lower_bound(nodes_.begin(), nodes_.end(), triangles.data()[k]);
    triangles_.data()[k] = static_cast<int>(at - nodes_.begin());
  }
  beyond_ = FindBeyond(triangles_);
  vertices_m_.setZero(3, ToIndex(nodes_.size()));
}

void MovingSurface::MoveTo(const Eigen::VectorXd& x_m, const Eigen::Isometry3d& T_camera_robot) {
  const Eigen::Matrix3d rotation = T_camera_robot.linear();
  const Eigen::Vector3d translation_m = T_camera_robot.translation();
  for (size_t v = 0; v < nodes_.size(); ++v) {
    vertices_m_.col(ToIndex(v)) = rotation * x_m.segment<3>(3 * nodes_[v]) + translation_m;
  }
}

SurfaceFoot MovingSurface::ClampTo(const Eigen::Vector3d& point_m, int triangle,
                                   const Eigen::Vector3d& normal) const {
  const Eigen::Vector3i corners = triangles_.col(triangle);
  const Eigen::Vector3d a = vertices_m_.col(corners[0]);
  const Eigen::Vector3d b = vertices_m_.col(corners[1]);
  const Eigen::Vector3d c = vertices_m_.col(corners[2]);
  const Eigen::Vector3d shares = geometry::ClosestPointOnTriangle(a, b, c, point_m);
  const Eigen::Vector3d offset_m = point_m - (shares[0] * a + shares[1] * b + shares[2] * c);
  return {triangle, shares, normal, normal.dot(offset_m), offset_m.norm(), false};
}

SurfaceFoot MovingSurface::FootOf(const Eigen::Vector3d& point_m, int start) const {
  int before = -1;
  int here = start;
  Eigen::Vector3d normal_before = Eigen::Vector3d::Zero();
  for (int step = 0;; ++step) {
    const Eigen::Vector3i corners = triangles_.col(here);
    const Projection on = Project(vertices_m_.col(corners[0]), vertices_m_.col(corners[1]),
                                  vertices_m_.col(corners[2]), point_m);
    if (on.normal.isZero(0.0)) return {};
    int farthest = 0;
    if (on.barycentric.minCoeff(&farthest) >= 0.0) {
      return {here, on.barycentric, on.normal, on.height_m, std::abs(on.height_m), false};
    }
    const int next = beyond_(farthest, here);
    if (next == before && next >= 0) {
      SurfaceFoot foot = ClampTo(point_m, here, (on.normal + normal_before).stableNormalized());
      foot.beyond_sharp_ridge = on.normal.dot(normal_before) < kSharp;
      return foot;
    }
    if (next < 0 || step == kMostSteps) return ClampTo(point_m, here, on.normal);
    normal_before = on.normal;
    before = here;
    here = next;
  }
}

}  // namespace palpate::correspondence
