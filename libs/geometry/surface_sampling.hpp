// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/geometry/triangle_surface.hpp"

namespace palpate::geometry {

/// Points on a surface, one column or entry for each.
struct SurfaceSamples {
  Eigen::Matrix3Xd positions_m;  ///< [3 x n]
  Eigen::Matrix3Xd normals;      ///< [3 x n] unit outward normals of the triangles
  std::vector<int> triangles;    ///< [n] the triangle of each

  int Count() const { return static_cast<int>(triangles.size()); }
};

/// `count` points of equal share of the area: systematic along the triangles, within each by the
/// additive recurrence of Roberts' R2 sequence. The same surface always gives the same points.
/// `surface` needs an area, count >= 1.
SurfaceSamples SampleByArea(const TriangleSurface& surface, int count);

/// Indices of `count` of the `points_m` [3 x n], n >= count: first the point farthest from their
/// mean, then again and again the one farthest from all chosen so far (Gonzalez 1985: the largest
/// gap is at most twice the smallest possible). Ties go to the lower index.
std::vector<int> FarthestPoints(const Eigen::Ref<const Eigen::Matrix3Xd>& points_m, int count);

/// `count` points evenly spread over the surface: farthest points among a dense sample.
SurfaceSamples SpreadEvenly(const TriangleSurface& surface, int count);

}  // namespace palpate::geometry
