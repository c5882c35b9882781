// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/mesh_io/orientation.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <tuple>
#include <vector>

namespace palpate::fem::mesh_io {

namespace {

/// Outward faces of a positive cell.
constexpr std::array<std::array<int, 3>, 4> kOutwardFaces = {
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

double SixfoldVolume_m3(const TetMesh& mesh, int cell) {
  const auto corner = [&](int k) -> Eigen::Vector3d {
    return mesh.nodes_m.col(mesh.cells(k, cell));
  };
  return (corner(1) - corner(0)).cross(corner(2) - corner(0)).dot(corner(3) - corner(0));
}

/// Exchanges corners 1 and 2, and with them the mid-edge nodes 01-02 and 13-23.
void Turn(int cell, Eigen::MatrixXi* cells) {
  std::swap((*cells)(1, cell), (*cells)(2, cell));
  if (cells->rows() == 4) return;
  std::swap((*cells)(4, cell), (*cells)(6, cell));
  std::swap((*cells)(8, cell), (*cells)(9, cell));
}

struct Face {
  std::array<int, 3> nodes{};  ///< rising
  bool even = false;           ///< its order in the cell is an even permutation of that

  auto operator<=>(const Face& other) const = default;
};

Face MakeFace(int a, int b, int c) {
  Face face{.nodes = {a, b, c}, .even = true};
  for (const auto& [i, j] : {std::pair{0, 1}, {1, 2}, {0, 1}}) {
    auto& first = face.nodes[static_cast<size_t>(i)];
    auto& second = face.nodes[static_cast<size_t>(j)];
    if (first <= second) continue;
    std::swap(first, second);
    face.even = !face.even;
  }
  return face;
}

/// Whether no two cells have a face from the same side.
bool LieOnOwnSides(const Eigen::MatrixXi& cells) {
  std::vector<Face> faces;
  faces.reserve(4 * static_cast<size_t>(cells.cols()));
  for (Eigen::Index cell = 0; cell < cells.cols(); ++cell) {
    for (const auto& [a, b, c] : kOutwardFaces) {
      faces.push_back(MakeFace(cells(a, cell), cells(b, cell), cells(c, cell)));
    }
  }
  std::sort(faces.begin(), faces.end());
  return std::adjacent_find(faces.begin(), faces.end()) == faces.end();
}

}  // namespace

std::string OrientCells(TetMesh* mesh) {
  std::vector<int> negative;
  int positive = 0;
  for (int cell = 0; cell < mesh->CellCount(); ++cell) {
    const double volume_m3 = SixfoldVolume_m3(*mesh, cell);
    positive += volume_m3 > 0.0 ? 1 : 0;
    if (volume_m3 < 0.0) negative.push_back(cell);
  }
  if (negative.empty()) return "";
  Eigen::MatrixXi turned = mesh->cells;
  if (positive == 0) {
    for (int cell = 0; cell < mesh->CellCount(); ++cell) Turn(cell, &turned);
    mesh->cells = std::move(turned);
    return "all cells are oriented the other way round and were turned";
  }
  for (const int cell : negative) Turn(cell, &turned);
  if (!LieOnOwnSides(turned)) return "";
  mesh->cells = std::move(turned);
  return std::to_string(negative.size()) + " of " + std::to_string(mesh->CellCount()) +
         " cells are oriented the other way round and were turned";
}

}  // namespace palpate::fem::mesh_io
