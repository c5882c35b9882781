// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/seams.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "libs/core/index.hpp"

namespace palpate::fem {

namespace {

constexpr double kToleranceOfDiagonal = 1e-6;
constexpr double kToleranceOfEdge = 1e-2;
constexpr std::array<std::array<int, 3>, 4> kSeamFaces = {
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
constexpr std::array<std::array<int, 2>, 6> kSeamEdges = {
    {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};

struct Face {
  std::array<int, 3> corners{};  ///< rising
  int cell = 0;
  int side = 0;  ///< of kSeamFaces
};

std::array<int, 3> Rising(std::array<int, 3> corners) {
  std::sort(corners.begin(), corners.end());
  return corners;
}

std::vector<Face> BoundaryFaces(const TetMesh& mesh) {
  std::vector<Face> faces;
  faces.reserve(4 * static_cast<size_t>(mesh.CellCount()));
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    for (int side = 0; side < 4; ++side) {
      const auto& [a, b, c] = kSeamFaces[At(side)];
      faces.push_back(
          {Rising({mesh.cells(a, cell), mesh.cells(b, cell), mesh.cells(c, cell)}), cell, side});
    }
  }
  std::sort(faces.begin(), faces.end(),
            [](const Face& a, const Face& b) { return a.corners < b.corners; });
  std::vector<Face> boundary;
  for (auto first = faces.begin(); first != faces.end();) {
    const auto last = std::find_if(
        first, faces.end(), [&](const Face& face) { return face.corners != first->corners; });
    if (last - first == 1) boundary.push_back(*first);
    first = last;
  }
  return boundary;
}

/// The nodes of a face, mid-edge nodes included.
std::vector<int> NodesOf(const TetMesh& mesh, const Face& face) {
  const auto& corners = kSeamFaces[At(face.side)];
  std::vector<int> nodes;
  for (const int corner : corners) nodes.push_back(mesh.cells(corner, face.cell));
  if (mesh.element_type() == ElementType::kTet4) return nodes;
  const auto has = [&](int corner) {
    return std::find(corners.begin(), corners.end(), corner) != corners.end();
  };
  for (int edge = 0; edge < 6; ++edge) {
    const auto& [i, j] = kSeamEdges[At(edge)];
    if (has(i) && has(j)) nodes.push_back(mesh.cells(4 + edge, face.cell));
  }
  return nodes;
}

double Tolerance_m(const TetMesh& mesh, const std::vector<Face>& boundary) {
  const Eigen::Vector3d size_m =
      mesh.nodes_m.rowwise().maxCoeff() - mesh.nodes_m.rowwise().minCoeff();
  double shortest_m = size_m.norm();
  for (const Face& face : boundary) {
    const auto& [a, b, c] = face.corners;
    for (const auto& [i, j] : {std::pair{a, b}, {b, c}, {a, c}}) {
      shortest_m = std::min(shortest_m, (mesh.nodes_m.col(i) - mesh.nodes_m.col(j)).norm());
    }
  }
  return std::min(kToleranceOfDiagonal * size_m.norm(), kToleranceOfEdge * shortest_m);
}

/// Finds for each node the lowest one at its place, with a grid of cells many tolerances wide.
class PlaceFinder {
 public:
  PlaceFinder(const TetMesh& mesh, double tolerance_m)
      : mesh_(mesh), tolerance_m_(tolerance_m), width_m_(16.0 * tolerance_m) {}

  /// Nodes must come by rising number.
  int LowestAt(int node) {
    const Eigen::Vector3d place_m = mesh_.nodes_m.col(node);
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d offset_m((corner & 1) != 0 ? tolerance_m_ : -tolerance_m_,
                                     (corner & 2) != 0 ? tolerance_m_ : -tolerance_m_,
                                     (corner & 4) != 0 ? tolerance_m_ : -tolerance_m_);
      const auto cell = nodes_.find(KeyOf(place_m + offset_m));
      if (cell == nodes_.end()) continue;
      for (const int other : cell->second) {
        if ((mesh_.nodes_m.col(other) - place_m).norm() <= tolerance_m_) return other;
      }
    }
    nodes_[KeyOf(place_m)].push_back(node);
    return node;
  }

 private:
  std::uint64_t KeyOf(const Eigen::Vector3d& place_m) const {
    std::uint64_t key = 0;
    for (const double x_m : place_m) {
      const auto step = static_cast<std::int64_t>(std::floor(x_m / width_m_));
      key = key * 0x9e3779b97f4a7c15ULL + static_cast<std::uint64_t>(step);
    }
    return key;
  }

  const TetMesh& mesh_;
  double tolerance_m_;
  double width_m_;
  std::unordered_map<std::uint64_t, std::vector<int>> nodes_;
};

/// [n] the lowest node of the boundary at the place of each; itself where there is no other.
std::vector<int> LowestNodeAtPlace(const TetMesh& mesh, const std::vector<Face>& boundary) {
  std::vector<bool> on_boundary(static_cast<size_t>(mesh.NodeCount()), false);
  for (const Face& face : boundary) {
    for (const int node : NodesOf(mesh, face)) on_boundary[At(node)] = true;
  }
  std::vector<int> lowest(static_cast<size_t>(mesh.NodeCount()));
  std::iota(lowest.begin(), lowest.end(), 0);
  const double tolerance_m = Tolerance_m(mesh, boundary);
  if (!(tolerance_m > 0.0)) return lowest;
  PlaceFinder finder(mesh, tolerance_m);
  for (int node = 0; node < mesh.NodeCount(); ++node) {
    if (on_boundary[At(node)]) lowest[At(node)] = finder.LowestAt(node);
  }
  return lowest;
}

}  // namespace

std::vector<int> JoinSeams(TetMesh* mesh) {
  const std::vector<Face> boundary = BoundaryFaces(*mesh);
  const std::vector<int> lowest = LowestNodeAtPlace(*mesh, boundary);
  std::map<std::array<int, 3>, std::vector<const Face*>> faces_at;
  for (const Face& face : boundary) {
    const auto& [a, b, c] = face.corners;
    faces_at[Rising({lowest[At(a)], lowest[At(b)], lowest[At(c)]})].push_back(&face);
  }
  std::vector<int> new_number(lowest.size());
  std::iota(new_number.begin(), new_number.end(), 0);
  std::vector<int> joined;
  for (const auto& [corners, faces] : faces_at) {
    if (faces.size() != 2) continue;
    for (const Face* face : faces) {
      for (const int node : NodesOf(*mesh, *face)) {
        if (lowest[At(node)] == node || new_number[At(node)] != node) continue;
        new_number[At(node)] = lowest[At(node)];
        joined.push_back(node);
      }
    }
  }
  for (int& node : mesh->cells.reshaped()) node = new_number[At(node)];
  std::sort(joined.begin(), joined.end());
  return joined;
}

}  // namespace palpate::fem
