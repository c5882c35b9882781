// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/marker_normals.hpp"

#include <Eigen/Geometry>

namespace palpate::diagnosis {

namespace {

/// A marker is a disc of some millimetres, and facets of a mesh are askew to the surface that they
/// stand for.
constexpr double kRadius_m = 6e-3;
/// Faces that look elsewhere belong to the body's other side.
constexpr double kSameSide = 0.5;

/// Along the normal, of twice the area.
Eigen::Vector3d AreaNormal(const Eigen::Vector3i& corners, const Eigen::VectorXd& x_m) {
  const Eigen::Vector3d a_m = x_m.segment<3>(3 * corners[0]);
  return (x_m.segment<3>(3 * corners[1]) - a_m).cross(x_m.segment<3>(3 * corners[2]) - a_m);
}

}  // namespace

MarkerNormals::MarkerNormals(const ModelHypothesis& hypothesis) {
  const geometry::SurfaceIndex& surface = hypothesis.places->surface();
  const Eigen::Matrix3Xi triangles = hypothesis.places->boundary().CornerTriangles();
  const Eigen::VectorXd rest_m = hypothesis.places->mesh().nodes_m.reshaped();
  for (const robot::BodyMarker& marker : hypothesis.body.markers) {
    const geometry::SurfacePoint nearest = surface.Closest(marker.point.rest_m);
    const Eigen::Vector3d outward =
        AreaNormal(triangles.col(nearest.triangle), rest_m).normalized();
    std::vector<int> about;
    for (const int face : surface.TrianglesWithin(nearest.position_m, kRadius_m)) {
      const Eigen::Vector3d normal = AreaNormal(triangles.col(face), rest_m).normalized();
      if (normal.dot(outward) > kSameSide) about.push_back(face);
    }
    if (about.empty()) about.push_back(nearest.triangle);
    faces_.emplace_back(triangles(Eigen::all, about));
  }
}

Eigen::Vector3d MarkerNormals::Normal(std::size_t marker, const Eigen::VectorXd& x_m) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& corners : faces_[marker].colwise()) sum += AreaNormal(corners, x_m);
  return sum.normalized();
}

}  // namespace palpate::diagnosis
