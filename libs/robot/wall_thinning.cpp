// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/wall_thinning.hpp"

#include <vector>

#include "libs/core/index.hpp"
#include "libs/geometry/box.hpp"
#include "libs/geometry/closest_point.hpp"
#include "libs/geometry/triangle_surface.hpp"

namespace palpate::robot {

namespace {

/// Faces that lie on the wall are of it: so much of the body's diagonal off.
constexpr double kOnWall = 1e-6;

geometry::TriangleSurface FlatWall(const fem::MovingSurface& wall, const Eigen::VectorXd& rest_m) {
  geometry::TriangleSurface flat{Eigen::Matrix3Xd(3, std::ssize(wall.points)),
                                 wall.faces.topRows<3>()};
  for (std::size_t p = 0; p < wall.points.size(); ++p) {
    flat.vertices_m.col(ToIndex(p)) = wall.points[p].Position(rest_m);
  }
  return flat;
}

/// The boundary without the faces of the wall.
geometry::TriangleSurface OtherSurfaces(const fem::TetMesh& mesh,
                                        const fem::BoundarySurface& boundary,
                                        const geometry::SurfaceIndex& wall) {
  const double on_wall_m = kOnWall * geometry::BoundingBox(mesh.nodes_m).Diagonal_m();
  std::vector<int> others;
  for (int face = 0; face < boundary.FaceCount(); ++face) {
    Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k) middle_m += mesh.nodes_m.col(boundary.faces(k, face)) / 3.0;
    if (wall.Closest(middle_m).distance_m > on_wall_m) others.push_back(face);
  }
  geometry::TriangleSurface surface{mesh.nodes_m, Eigen::Matrix3Xi(3, std::ssize(others))};
  for (std::size_t k = 0; k < others.size(); ++k) {
    surface.triangles.col(ToIndex(k)) = boundary.faces.col(others[k]).head<3>();
  }
  return surface;
}

}  // namespace

Eigen::VectorXd WallThinning(const fem::TetMesh& mesh, const fem::BoundarySurface& boundary,
                             const fem::MovingSurface& wall) {
  const geometry::SurfaceIndex chamber(FlatWall(wall, mesh.nodes_m.reshaped()));
  const Eigen::Matrix3Xd normals = geometry::VertexNormals(chamber.surface());
  const geometry::SurfaceIndex others(OtherSurfaces(mesh, boundary, chamber));
  Eigen::VectorXd mode_m = Eigen::VectorXd::Zero(mesh.nodes_m.size());
  for (Eigen::Index node = 0; node < mesh.nodes_m.cols(); ++node) {
    const geometry::SurfacePoint at_wall = chamber.Closest(mesh.nodes_m.col(node));
    const double to_other_m = others.Closest(mesh.nodes_m.col(node)).distance_m;
    const double between_m = at_wall.distance_m + to_other_m;
    if (!(between_m > 0.0)) continue;  // where the wall meets another surface
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k) {
      const int vertex = chamber.surface().triangles(k, at_wall.triangle);
      normal += at_wall.barycentric[k] * normals.col(vertex);
    }
    mode_m.segment<3>(3 * node) = to_other_m / between_m * normal.normalized();
  }
  return mode_m;
}

}  // namespace palpate::robot
