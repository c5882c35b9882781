// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace palpate::geometry {

/// A surface of flat triangles, counter-clockwise seen from outside.
struct TriangleSurface {
  Eigen::Matrix3Xd vertices_m;  ///< [3 x v]; vertices that no triangle uses are allowed
  Eigen::Matrix3Xi triangles;   ///< [3 x t] vertex indices

  int TriangleCount() const { return static_cast<int>(triangles.cols()); }
  Eigen::Vector3d Corner(int triangle, int corner) const {
    return vertices_m.col(triangles(corner, triangle));
  }
};

/// Half the cross product of two edges: outward normal times area, m2.
Eigen::Vector3d TriangleAreaVector_m2(const TriangleSurface& surface, int triangle);

/// Unit outward normal; zero for a triangle without area.
Eigen::Vector3d TriangleNormal(const TriangleSurface& surface, int triangle);

double SurfaceArea_m2(const TriangleSurface& surface);

/// [3 x v] unit normals, means of the adjoining triangles weighted by area; zero where no triangle
/// with an area adjoins.
Eigen::Matrix3Xd VertexNormals(const TriangleSurface& surface);

/// The volume that a closed surface encloses (divergence theorem), m3; negative when inside out.
double EnclosedVolume_m3(const TriangleSurface& surface);

}  // namespace palpate::geometry
