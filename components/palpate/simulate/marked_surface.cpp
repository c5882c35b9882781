// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/simulate/marked_surface.hpp"

#include <Eigen/Geometry>

#include "libs/core/index.hpp"
#include "libs/geometry/closest_point.hpp"

namespace palpate::command {

MarkedSurface::MarkedSurface(const fem::TetMesh& mesh, const fem::BoundarySurface& boundary,
                             const Eigen::Matrix3Xd& markers_m, double radius_m) {
  const geometry::SurfaceIndex skin(fem::RestSurface(mesh, boundary));
  const Eigen::Matrix3Xi corners = boundary.CornerTriangles();
  for (const auto& marker_m : markers_m.colwise()) {
    const geometry::SurfacePoint nearest = skin.Closest(marker_m);
    std::vector<int> facets = skin.TrianglesWithin(nearest.position_m, radius_m);
    if (facets.empty()) facets.push_back(nearest.triangle);
    facets_.emplace_back(corners(Eigen::all, facets));
  }
}

Eigen::Matrix3Xd MarkedSurface::Normals(const Eigen::VectorXd& x_m) const {
  Eigen::Matrix3Xd normals = Eigen::Matrix3Xd::Zero(3, std::ssize(facets_));
  for (Eigen::Index m = 0; m < normals.cols(); ++m) {
    for (const auto& corners : facets_[At(m)].colwise()) {
      const auto corner_m = [&](int k) { return x_m.segment<3>(3 * corners[k]); };
      normals.col(m) += (corner_m(1) - corner_m(0)).cross(corner_m(2) - corner_m(0));
    }
  }
  return normals.colwise().normalized();
}

}  // namespace palpate::command
