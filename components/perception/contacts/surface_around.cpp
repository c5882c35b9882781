// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/contacts/surface_around.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <vector>

#include "libs/core/check.hpp"
#include "libs/geometry/closest_point.hpp"

namespace palpate::perception {

namespace {

/// Triangles with a common edge are equally near to a place above it.
constexpr double kSameDistance_m = 1e-9;

}  // namespace

SurfaceAround::SurfaceAround(const PredictedSurface& surface, const Eigen::Vector3d& place_m,
                             double radius_m, const SurfaceAroundTuning& tuning)
    : tuning_(tuning) {
  std::vector<int> near;
  for (const auto& corners : surface.triangles.colwise()) {
    const Eigen::Matrix3d triangle_m = surface.vertices_m(Eigen::all, corners);
    const Eigen::Vector3d lower_m = triangle_m.rowwise().minCoeff().array() - radius_m;
    const Eigen::Vector3d upper_m = triangle_m.rowwise().maxCoeff().array() + radius_m;
    const bool is_near =
        (place_m.array() >= lower_m.array()).all() && (place_m.array() <= upper_m.array()).all();
    if (is_near) near.insert(near.end(), corners.begin(), corners.end());
  }
  corners_m_ = surface.vertices_m(Eigen::all, near);
}

/// On an edge the triangle counts whose normal points most to the place: one that is edge-on from
/// there does not decide whether the place is inside.
NearestSurface SurfaceAround::Nearest(const Eigen::Vector3d& place_m) const {
  PALPATE_CHECK(!empty());
  NearestSurface nearest;
  double least_m = std::numeric_limits<double>::infinity();
  double squarest_m = 0.0;
  for (Eigen::Index t = 0; t < corners_m_.cols(); t += 3) {
    const auto triangle_m = corners_m_.middleCols<3>(t);
    const Eigen::Vector3d point_m =
        triangle_m * geometry::ClosestPointOnTriangle(triangle_m.col(0), triangle_m.col(1),
                                                      triangle_m.col(2), place_m);
    const double distance_m = (place_m - point_m).norm();
    if (distance_m > least_m + kSameDistance_m) continue;
    const Eigen::Vector3d normal = (triangle_m.col(1) - triangle_m.col(0))
                                       .cross(triangle_m.col(2) - triangle_m.col(0))
                                       .normalized();
    const double over_m = normal.dot(place_m - point_m);
    if (distance_m > least_m - kSameDistance_m && std::abs(over_m) <= squarest_m) continue;
    least_m = distance_m;
    squarest_m = std::abs(over_m);
    nearest.position_m = point_m;
    nearest.height_m = over_m < 0.0 ? -distance_m : distance_m;
    nearest.outward =
        distance_m > kSameDistance_m ? ((place_m - point_m) / nearest.height_m).eval() : normal;
  }
  return nearest;
}

}  // namespace palpate::perception
