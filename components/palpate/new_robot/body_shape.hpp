// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/boundary_surface.hpp"
#include "libs/fem/tet_mesh.hpp"
#include "libs/geometry/box.hpp"
#include "libs/geometry/triangle_surface.hpp"

namespace palpate::command {

/// A flat part of the surface with all of the body on one side of it: an end of the body.
struct FlatFace {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, outward
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();
  double area_m2 = 0.0;
  std::vector<int> nodes;  ///< of the mesh, rising
};

/// What the mesh alone says of a body. Lengths in m, in the frame of the mesh file.
struct BodyShape {
  fem::TetMesh mesh;              ///< of 10-node elements
  std::vector<bool> used;         ///< [nodes] whether an element names it
  fem::BoundarySurface boundary;  ///< of `mesh`
  geometry::TriangleSurface surface;
  std::vector<int> outer_faces;  ///< of the boundary, without walls of closed cavities
  geometry::Box box;
  double diagonal_m = 0.0;
  double element_m = 0.0;                                ///< median edge of the elements' corners
  Eigen::Vector3d centroid_m = Eigen::Vector3d::Zero();  ///< of the volume
  /// Principal axes of the volume, the longest first (columns), and the body's extent along each.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Eigen::Vector3d extents_m = Eigen::Vector3d::Zero();
  std::vector<FlatFace> flat_faces;  ///< the largest first

  /// Distance along the surface's normal by which nodes of one flat face may differ.
  double flatness_m() const { return 0.02 * element_m; }
  /// Half again as long as wide: it has two ends.
  bool is_long() const { return extents_m(0) > 1.5 * extents_m(1); }
};

/// `mesh` in m.
BodyShape MeasureShape(const fem::TetMesh& mesh);

}  // namespace palpate::command
