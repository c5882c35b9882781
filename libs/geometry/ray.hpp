// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>

#include "libs/geometry/closest_point.hpp"
#include "libs/geometry/triangle_surface.hpp"

namespace palpate::geometry {

/// Where the ray from `origin_m` along `direction` (not zero) first meets a triangle of the
/// surface, from either side; touching an edge counts. `distance_m` is from the origin. Nothing
/// where it meets none. One pass over all triangles (Moeller and Trumbore 1997).
std::optional<SurfacePoint> FirstOnRay(const TriangleSurface& surface,
                                       const Eigen::Vector3d& origin_m,
                                       const Eigen::Vector3d& direction);

}  // namespace palpate::geometry
