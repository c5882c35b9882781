// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/monitor/fixed_surface_region.hpp"

#include "libs/core/index.hpp"

namespace palpate::force_estimation {

namespace {

geometry::TriangleSurface DrawnSurfaceOf(const robot::RobotBody& body) {
  return {body.mesh.nodes_m, body.boundary.DrawnTriangles()};
}

/// Nodes of the surface that are fixed in all directions, m.
std::vector<Eigen::Vector3d> FixedNodes(const robot::RobotBody& body,
                                        const geometry::TriangleSurface& surface) {
  std::vector<bool> taken(static_cast<std::size_t>(surface.vertices_m.cols()), false);
  std::vector<Eigen::Vector3d> fixed_m;
  for (const int node : surface.triangles.reshaped()) {
    if (taken[At(node)] || !body.fixed.col(node).all()) continue;
    taken[At(node)] = true;
    fixed_m.emplace_back(surface.vertices_m.col(node));
  }
  return fixed_m;
}

}  // namespace

FixedSurfaceRegion::FixedSurfaceRegion(const robot::RobotBody& body,
                                       const FixedSurfaceRegionTuning& tuning)
    : index_(DrawnSurfaceOf(body)) {
  const geometry::TriangleSurface& surface = index_.surface();
  const std::vector<Eigen::Vector3d> fixed_m = FixedNodes(body, surface);
  const double near_m = tuning.near_share * geometry::BoundingBox(surface.vertices_m).Diagonal_m();
  const auto is_near = [&](const Eigen::Vector3d& vertex_m) {
    for (const Eigen::Vector3d& node_m : fixed_m) {
      if ((node_m - vertex_m).norm() <= near_m) return true;
    }
    return false;
  };
  bool first = true;
  for (int t = 0; t < surface.TriangleCount(); ++t) {
    Eigen::Matrix3d corners_m;
    for (int k = 0; k < 3; ++k) corners_m.col(k) = surface.Corner(t, k);
    is_fixed_.push_back(is_near(corners_m.col(0)) && is_near(corners_m.col(1)) &&
                        is_near(corners_m.col(2)));
    if (!is_fixed_.back()) continue;
    const geometry::Box box = geometry::BoundingBox(corners_m);
    box_.lower_m = first ? box.lower_m : Eigen::Vector3d(box_.lower_m.cwiseMin(box.lower_m));
    box_.upper_m = first ? box.upper_m : Eigen::Vector3d(box_.upper_m.cwiseMax(box.upper_m));
    first = false;
  }
}

std::optional<FixedSurfacePoint> FixedSurfaceRegion::PlaceOf(const Eigen::Vector3d& point_m,
                                                             double reach_m,
                                                             const Eigen::VectorXd& x_m) const {
  if (!MayHold(point_m, reach_m)) return std::nullopt;
  const geometry::SurfacePoint nearest = index_.Closest(point_m);
  if (nearest.distance_m > reach_m || !is_fixed_[At(nearest.triangle)]) {
    return std::nullopt;
  }
  const geometry::TriangleSurface& surface = index_.surface();
  FixedSurfacePoint place{nearest.position_m, geometry::TriangleNormal(surface, nearest.triangle)};
  if (x_m.size() == 0) return place;
  for (int k = 0; k < 3; ++k) {
    const int node = surface.triangles(k, nearest.triangle);
    place.position_m +=
        nearest.barycentric[k] * (x_m.segment<3>(3 * node) - surface.vertices_m.col(node));
  }
  return place;
}

}  // namespace palpate::force_estimation
