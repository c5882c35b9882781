// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/tet_mesh.hpp"
#include "libs/geometry/triangle_surface.hpp"

namespace palpate::fem {

/// The faces that belong to one cell only, in the order of cells.
struct BoundarySurface {
  /// [3 or 6 x f] node indices: corners counter-clockwise seen from outside, then, for tet10, the
  /// nodes on the edges 01, 12, 20 of the face.
  Eigen::MatrixXi faces;
  Eigen::VectorXi cells;  ///< [f] the cell of each face

  int FaceCount() const { return static_cast<int>(faces.cols()); }
  /// [3 x f] flat triangles between the corners; column f is face f.
  Eigen::Matrix3Xi CornerTriangles() const { return faces.topRows<3>(); }
  /// Triangles for drawing: one for each face of tet4, four for each of tet10 (its edges bend).
  Eigen::Matrix3Xi DrawnTriangles() const;
};

BoundarySurface ExtractBoundary(const TetMesh& mesh);

/// The faces that something outside the body can touch, in rising order: those of all shells (faces
/// connected over edges) but the walls of closed cavities, and what lies inside these.
std::vector<int> OuterFaces(const TetMesh& mesh, const BoundarySurface& boundary);

/// The walls of closed cavities: faces of each shell whose normals point into what it encloses, in
/// rising order; shells in the order of their first faces.
std::vector<std::vector<int>> InnerSkins(const TetMesh& mesh, const BoundarySurface& boundary);

/// The corner triangles at rest; triangle f is face f of `boundary`.
geometry::TriangleSurface RestSurface(const TetMesh& mesh, const BoundarySurface& boundary);

}  // namespace palpate::fem
