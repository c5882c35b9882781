// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/libs/fem/verification/grid_mesh.hpp"

#include <array>
#include <random>

namespace palpate::fem::verification {

namespace {

/// The six ways to go from corner 000 to 111 of a brick along its edges; corners are numbered by
/// the bits of (x, y, z). Each is a positively oriented tetrahedron.
constexpr std::array<std::array<int, 4>, 6> kPaths{
    {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};

TetMesh MakeUnitGrid(const Eigen::Array3i& cells) {
  const Eigen::Array3i nodes = cells + 1;
  TetMesh mesh;
  mesh.nodes_m.resize(3, nodes.prod());
  for (int n = 0; n < nodes.prod(); ++n) {
    const Eigen::Array3i index(n % nodes[0], n / nodes[0] % nodes[1], n / nodes[0] / nodes[1]);
    mesh.nodes_m.col(n) = (index.cast<double>() / cells.cast<double>()).matrix();
  }
  mesh.cells.resize(4, 6 * cells.prod());
  int cell = 0;
  for (int b = 0; b < cells.prod(); ++b) {
    const Eigen::Array3i brick(b % cells[0], b / cells[0] % cells[1], b / cells[0] / cells[1]);
    for (const auto& path : kPaths) {
      for (int k = 0; k < 4; ++k) {
        const int corner = path[static_cast<size_t>(k)];
        const Eigen::Array3i at = brick + Eigen::Array3i(corner & 1, corner >> 1 & 1, corner >> 2);
        mesh.cells(k, cell) = at[0] + nodes[0] * (at[1] + nodes[1] * at[2]);
      }
      ++cell;
    }
  }
  return mesh;
}

}  // namespace

TetMesh MakeGrid(const Eigen::Array3i& cells, ElementType element, const PointMap& map) {
  TetMesh mesh = MakeUnitGrid(cells);
  if (element == ElementType::kTet10) mesh = MakeQuadratic(mesh);
  for (int n = 0; n < mesh.NodeCount(); ++n) mesh.nodes_m.col(n) = map(mesh.nodes_m.col(n));
  return mesh;
}

TetMesh MakeBox(const Eigen::Array3i& cells, ElementType element, const Eigen::Vector3d& size_m) {
  return MakeGrid(cells, element, [&](const Eigen::Vector3d& p) {
    return Eigen::Vector3d(p.cwiseProduct(size_m));
  });
}

TetMesh Distort(const TetMesh& tet4_box, const Eigen::Array3i& cells, double fraction,
                const Eigen::Vector3d& size_m) {
  TetMesh mesh = tet4_box;
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> move(-fraction, fraction);
  for (int n = 0; n < mesh.NodeCount(); ++n) {
    const Eigen::Array3d relative = mesh.nodes_m.col(n).array() / size_m.array();
    if ((relative < 1e-9).any() || (relative > 1.0 - 1e-9).any()) continue;
    for (int i = 0; i < 3; ++i) mesh.nodes_m(i, n) += move(engine) * size_m[i] / cells[i];
  }
  return mesh;
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
