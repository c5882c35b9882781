// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cmath>
#include <numbers>

#include "libs/geometry/triangle_surface.hpp"

namespace palpate::geometry {

/// The unit cube [0, 1]^3, twelve triangles, outward.
inline TriangleSurface UnitCube() {
  TriangleSurface cube{Eigen::Matrix3Xd(3, 8), Eigen::Matrix3Xi(3, 12)};
  cube.vertices_m << 0, 1, 0, 1, 0, 1, 0, 1,  //
      0, 0, 1, 1, 0, 0, 1, 1,                 //
      0, 0, 0, 0, 1, 1, 1, 1;
  cube.triangles << 0, 0, 4, 4, 0, 0, 2, 2, 0, 0, 1, 1,  //
      2, 3, 5, 7, 1, 5, 6, 7, 4, 6, 3, 7,                //
      3, 1, 7, 6, 5, 4, 7, 3, 6, 2, 7, 5;
  return cube;
}

/// Points (cos, sin) of latitude and longitude on a sphere round the origin.
inline TriangleSurface Sphere(double radius_m, int rings, int sectors) {
  TriangleSurface sphere{Eigen::Matrix3Xd(3, (rings + 1) * sectors),
                         Eigen::Matrix3Xi(3, 2 * rings * sectors)};
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      const double latitude = std::numbers::pi * (static_cast<double>(i) / rings - 0.5);
      const double longitude = 2.0 * std::numbers::pi * j / sectors;
      sphere.vertices_m.col(i * sectors + j) << radius_m * std::cos(latitude) * std::cos(longitude),
          radius_m * std::cos(latitude) * std::sin(longitude), radius_m * std::sin(latitude);
    }
  }
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      const int a = i * sectors + j;
      const int b = i * sectors + (j + 1) % sectors;
      sphere.triangles.col(2 * (i * sectors + j)) << a, b, b + sectors;
      sphere.triangles.col(2 * (i * sectors + j) + 1) << a, b + sectors, a + sectors;
    }
  }
  return sphere;
}

}  // namespace palpate::geometry
