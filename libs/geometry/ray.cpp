// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/geometry/ray.hpp"

#include "libs/core/check.hpp"

namespace palpate::geometry {

std::optional<SurfacePoint> FirstOnRay(const TriangleSurface& surface,
                                       const Eigen::Vector3d& origin_m,
                                       const Eigen::Vector3d& direction) {
  PALPATE_CHECK(!direction.isZero(0.0), direction.transpose());
  std::optional<SurfacePoint> first;
  const double length = direction.norm();
  for (int t = 0; t < surface.TriangleCount(); ++t) {
    const Eigen::Vector3d corner_m = surface.Corner(t, 0);
    const Eigen::Vector3d edge1_m = surface.Corner(t, 1) - corner_m;
    const Eigen::Vector3d edge2_m = surface.Corner(t, 2) - corner_m;
    const Eigen::Vector3d p = direction.cross(edge2_m);
    const double determinant = edge1_m.dot(p);
    if (determinant == 0.0) continue;  // parallel to the triangle
    const Eigen::Vector3d from_corner_m = origin_m - corner_m;
    const double u = from_corner_m.dot(p) / determinant;
    const Eigen::Vector3d q = from_corner_m.cross(edge1_m);
    const double v = direction.dot(q) / determinant;
    const double along = edge2_m.dot(q) / determinant;
    if (!(u >= 0.0 && v >= 0.0 && u + v <= 1.0 && along > 0.0)) continue;
    if (first && first->distance_m <= along * length) continue;
    first = {.triangle = t,
             .barycentric = {1.0 - u - v, u, v},
             .position_m = origin_m + along * direction,
             .distance_m = along * length};
  }
  return first;
}

}  // namespace palpate::geometry
