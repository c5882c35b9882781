// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/geometry/triangle_surface.hpp"

namespace palpate::geometry {

namespace {

Eigen::Vector3d UnitOrZero(const Eigen::Vector3d& vector) {
  const double length = vector.norm();
  return length > 0.0 ? Eigen::Vector3d(vector / length) : Eigen::Vector3d::Zero();
}

}  // namespace

Eigen::Vector3d TriangleAreaVector_m2(const TriangleSurface& surface, int triangle) {
  const Eigen::Vector3d corner_m = surface.Corner(triangle, 0);
  const Eigen::Vector3d edge_01_m = surface.Corner(triangle, 1) - corner_m;
  const Eigen::Vector3d edge_02_m = surface.Corner(triangle, 2) - corner_m;
  return 0.5 * edge_01_m.cross(edge_02_m);
}

Eigen::Vector3d TriangleNormal(const TriangleSurface& surface, int triangle) {
  return UnitOrZero(TriangleAreaVector_m2(surface, triangle));
}

double SurfaceArea_m2(const TriangleSurface& surface) {
  double area_m2 = 0.0;
  for (int t = 0; t < surface.TriangleCount(); ++t) {
    area_m2 += TriangleAreaVector_m2(surface, t).norm();
  }
  return area_m2;
}

Eigen::Matrix3Xd VertexNormals(const TriangleSurface& surface) {
  Eigen::Matrix3Xd normals = Eigen::Matrix3Xd::Zero(3, surface.vertices_m.cols());
  for (int t = 0; t < surface.TriangleCount(); ++t) {
    const Eigen::Vector3d area_vector_m2 = TriangleAreaVector_m2(surface, t);
    for (int k = 0; k < 3; ++k) normals.col(surface.triangles(k, t)) += area_vector_m2;
  }
  for (Eigen::Index v = 0; v < normals.cols(); ++v) normals.col(v) = UnitOrZero(normals.col(v));
  return normals;
}

double EnclosedVolume_m3(const TriangleSurface& surface) {
  double volume_m3 = 0.0;
  for (int t = 0; t < surface.TriangleCount(); ++t) {
    volume_m3 += surface.Corner(t, 0).dot(TriangleAreaVector_m2(surface, t)) / 3.0;
  }
  return volume_m3;
}

}  // namespace palpate::geometry
