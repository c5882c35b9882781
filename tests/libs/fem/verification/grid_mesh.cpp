// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/libs/fem/verification/grid_mesh.hpp"

#include <array>
#include <bit>
#include <random>
#include <utility>

namespace palpate::fem::verification {

namespace {

using Tet = std::array<int, 4>;

/// Bricks as positively oriented tetrahedra; corners are numbered by the bits of (x, y, z).
const std::vector<Tet> kFiveTets{
    {0, 1, 2, 4}, {3, 2, 1, 7}, {5, 4, 7, 1}, {6, 7, 4, 2}, {1, 2, 4, 7}};
const std::vector<Tet> kSixTets{{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                                {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};

/// The directions, as bits, in which a brick is the mirror image of the pattern.
int MirrorBits(const Eigen::Array3i& brick, const Eigen::Array3i& cells, Cut cut) {
  if (cut == Cut::kFive) return brick.sum() % 2;
  return (2 * brick[1] >= cells[1] ? 2 : 0) + (2 * brick[2] >= cells[2] ? 4 : 0);
}

/// The tet in a mirrored brick; an odd number of mirrors swaps two corners to mend the orientation.
Tet Mirror(Tet tet, int bits) {
  for (int& corner : tet) corner ^= bits;
  if (std::popcount(static_cast<unsigned>(bits)) % 2 == 1) std::swap(tet[2], tet[3]);
  return tet;
}

TetMesh MakeUnitGrid(const Eigen::Array3i& cells, Cut cut) {
  const Eigen::Array3i nodes = cells + 1;
  TetMesh mesh;
  mesh.nodes_m.resize(3, nodes.prod());
  for (int n = 0; n < nodes.prod(); ++n) {
    const Eigen::Array3i index(n % nodes[0], n / nodes[0] % nodes[1], n / nodes[0] / nodes[1]);
    mesh.nodes_m.col(n) = (index.cast<double>() / cells.cast<double>()).matrix();
  }
  const std::vector<Tet>& tets = cut == Cut::kFive ? kFiveTets : kSixTets;
  mesh.cells.resize(4, static_cast<Eigen::Index>(tets.size()) * cells.prod());
  Eigen::Index cell = 0;
  for (int b = 0; b < cells.prod(); ++b) {
    const Eigen::Array3i brick(b % cells[0], b / cells[0] % cells[1], b / cells[0] / cells[1]);
    const int mirrors = MirrorBits(brick, cells, cut);
    for (const Tet& tet : tets) {
      Eigen::Index k = 0;
      for (int corner : Mirror(tet, mirrors)) {
        const Eigen::Array3i at = brick + Eigen::Array3i(corner & 1, corner >> 1 & 1, corner >> 2);
        mesh.cells(k++, cell) = at[0] + nodes[0] * (at[1] + nodes[1] * at[2]);
      }
      ++cell;
    }
  }
  return mesh;
}

}  // namespace

TetMesh MakeGrid(const Eigen::Array3i& cells, ElementType element, const PointMap& map, Cut cut) {
  TetMesh mesh = MakeUnitGrid(cells, cut);
  if (element == ElementType::kTet10) mesh = MakeQuadratic(mesh);
  for (int n = 0; n < mesh.NodeCount(); ++n) mesh.nodes_m.col(n) = map(mesh.nodes_m.col(n));
  return mesh;
}

TetMesh MakeBox(const Eigen::Array3i& cells, ElementType element, const Eigen::Vector3d& size_m,
                Cut cut) {
  const auto scale = [&](const Eigen::Vector3d& p) {
    return Eigen::Vector3d(p.cwiseProduct(size_m));
  };
  return MakeGrid(cells, element, scale, cut);
}

TetMesh MakeDistortedBox(const Eigen::Array3i& cells, ElementType element,
                         const Eigen::Vector3d& size_m, double fraction) {
  TetMesh mesh = MakeBox(cells, ElementType::kTet4, size_m);
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> move(-fraction, fraction);
  for (int n = 0; n < mesh.NodeCount(); ++n) {
    const Eigen::Array3d relative = mesh.nodes_m.col(n).array() / size_m.array();
    if ((relative < 1e-9).any() || (relative > 1.0 - 1e-9).any()) continue;
    for (int i = 0; i < 3; ++i) mesh.nodes_m(i, n) += move(engine) * size_m[i] / cells[i];
  }
  return element == ElementType::kTet10 ? MakeQuadratic(mesh) : mesh;
}

std::vector<int> NodesWhere(const TetMesh& mesh, const PointTest& test) {
  std::vector<int> found;
  for (int n = 0; n < mesh.NodeCount(); ++n) {
    if (test(mesh.nodes_m.col(n))) found.push_back(n);
  }
  return found;
}

int NearestNode(const TetMesh& mesh, const Eigen::Vector3d& point_m) {
  Eigen::Index nearest = 0;
  (mesh.nodes_m.colwise() - point_m).colwise().squaredNorm().minCoeff(&nearest);
  return static_cast<int>(nearest);
}

}  // namespace palpate::fem::verification
