// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/refined_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"

namespace palpate::fem {

namespace {

using Corners = std::array<int, 4>;

/// Nodes of a tet10 cell, as in ElementType.
constexpr std::array<Corners, 4> kAtCorners = {
    {{0, 4, 6, 7}, {4, 1, 5, 8}, {6, 5, 2, 9}, {7, 8, 9, 3}}};

/// The mid-edge nodes are the corners of an octahedron.
struct Diagonal {
  int from;
  int to;
  Corners around;  ///< the other four; neighbours share an edge of the octahedron
};
constexpr std::array<Diagonal, 3> kDiagonals = {
    {{4, 9, {5, 8, 7, 6}}, {5, 7, {4, 6, 9, 8}}, {6, 8, {4, 5, 9, 7}}}};

class CellCutter {
 public:
  explicit CellCutter(const TetMesh& quadratic)
      : quadratic_(quadratic), cells_(4, 8 * quadratic.CellCount()) {
    for (int cell = 0; cell < quadratic.CellCount(); ++cell) Cut(cell);
  }
  const Eigen::MatrixXi& cells() const { return cells_; }

 private:
  Eigen::Vector3d Node_m(int cell, int node) const {
    return quadratic_.nodes_m.col(quadratic_.cells(node, cell));
  }
  double Length_m(int cell, const Diagonal& diagonal) const {
    return (Node_m(cell, diagonal.to) - Node_m(cell, diagonal.from)).norm();
  }
  double SignedVolume(int cell, const Corners& corners) const {
    const Eigen::Vector3d origin_m = Node_m(cell, corners[0]);
    return (Node_m(cell, corners[1]) - origin_m)
        .cross(Node_m(cell, corners[2]) - origin_m)
        .dot(Node_m(cell, corners[3]) - origin_m);
  }

  void Cut(int cell) {
    for (const Corners& corners : kAtCorners) Add(cell, corners);
    const Diagonal& shortest = *std::min_element(kDiagonals.begin(), kDiagonals.end(),
                                                 [&](const Diagonal& a, const Diagonal& b) {
                                                   return Length_m(cell, a) < Length_m(cell, b);
                                                 });
    const bool turned = SignedVolume(cell, {0, 1, 2, 3}) *
                            SignedVolume(cell, {shortest.from, shortest.to, shortest.around[0],
                                                shortest.around[1]}) <
                        0.0;
    for (size_t k = 0; k < 4; ++k) {
      const int first = shortest.around[k];
      const int second = shortest.around[(k + 1) % 4];
      Add(cell, {shortest.from, shortest.to, turned ? second : first, turned ? first : second});
    }
  }

  void Add(int cell, const Corners& corners) {
    for (int k = 0; k < 4; ++k) {
      cells_(k, count_) = quadratic_.cells(corners[At(k)], cell);
    }
    ++count_;
  }

  const TetMesh& quadratic_;
  Eigen::MatrixXi cells_;
  int count_ = 0;
};

}  // namespace

TetMesh RefineUniformly(const TetMesh& mesh) {
  PALPATE_CHECK(mesh.element_type() == ElementType::kTet4, mesh.cells.rows());
  const TetMesh quadratic = MakeQuadratic(mesh);
  return {.nodes_m = quadratic.nodes_m, .cells = CellCutter(quadratic).cells(), .groups = {}};
}

}  // namespace palpate::fem
