// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/boundary_surface.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "libs/core/index.hpp"

namespace palpate::fem {

namespace {

/// Local nodes of the four faces of a tetrahedron, outward: corners, then mid-edges 01, 12, 20.
constexpr std::array<std::array<int, 6>, 4> kFaces{
    {{0, 2, 1, 6, 5, 4}, {0, 1, 3, 4, 8, 7}, {1, 2, 3, 5, 9, 8}, {0, 3, 2, 7, 9, 6}}};

struct Face {
  std::array<int, 3> sorted_corners;
  int cell;
  int local;
};

std::vector<Face> AllFaces(const TetMesh& mesh) {
  std::vector<Face> faces;
  faces.reserve(4 * static_cast<size_t>(mesh.CellCount()));
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    for (size_t local = 0; local < kFaces.size(); ++local) {
      Face face{{mesh.cells(kFaces[local][0], cell), mesh.cells(kFaces[local][1], cell),
                 mesh.cells(kFaces[local][2], cell)},
                cell,
                static_cast<int>(local)};
      std::sort(face.sorted_corners.begin(), face.sorted_corners.end());
      faces.push_back(face);
    }
  }
  return faces;
}

/// The faces whose three corners no other face has, in the order of cells.
std::vector<Face> SingleFaces(std::vector<Face> faces) {
  std::stable_sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
    return a.sorted_corners < b.sorted_corners;
  });
  std::vector<Face> single;
  for (size_t first = 0; first < faces.size();) {
    size_t next = first + 1;
    while (next < faces.size() && faces[next].sorted_corners == faces[first].sorted_corners) ++next;
    if (next == first + 1) single.push_back(faces[first]);
    first = next;
  }
  std::sort(single.begin(), single.end(), [](const Face& a, const Face& b) {
    return std::pair(a.cell, a.local) < std::pair(b.cell, b.local);
  });
  return single;
}

}  // namespace

BoundarySurface ExtractBoundary(const TetMesh& mesh) {
  const std::vector<Face> single = SingleFaces(AllFaces(mesh));
  const auto count = ToIndex(single.size());
  const Eigen::Index nodes_per_face = mesh.element_type() == ElementType::kTet10 ? 6 : 3;
  BoundarySurface boundary{Eigen::MatrixXi(nodes_per_face, count), Eigen::VectorXi(count)};
  for (Eigen::Index f = 0; f < count; ++f) {
    const Face& face = single[At(f)];
    const auto& local_nodes = kFaces[At(face.local)];
    for (Eigen::Index k = 0; k < nodes_per_face; ++k) {
      boundary.faces(k, f) = mesh.cells(local_nodes[At(k)], face.cell);
    }
    boundary.cells(f) = face.cell;
  }
  return boundary;
}

Eigen::Matrix3Xi BoundarySurface::DrawnTriangles() const {
  if (faces.rows() == 3) return CornerTriangles();
  constexpr std::array<std::array<int, 3>, 4> kParts{{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};
  Eigen::Matrix3Xi triangles(3, 4 * faces.cols());
  for (Eigen::Index f = 0; f < faces.cols(); ++f) {
    for (Eigen::Index part = 0; part < 4; ++part) {
      for (Eigen::Index k = 0; k < 3; ++k) {
        const int local = kParts[At(part)][At(k)];
        triangles(k, 4 * f + part) = faces(local, f);
      }
    }
  }
  return triangles;
}

geometry::TriangleSurface RestSurface(const TetMesh& mesh, const BoundarySurface& boundary) {
  return {mesh.nodes_m, boundary.CornerTriangles()};
}

}  // namespace palpate::fem
