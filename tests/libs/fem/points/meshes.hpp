// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "libs/fem/tet_mesh.hpp"

namespace palpate::fem {

/// A box [0, size_m] of `counts` bricks, each split into six tetrahedra round its diagonal.
inline TetMesh BoxMesh(const Eigen::Vector3d& size_m, const Eigen::Vector3i& counts) {
  const Eigen::Vector3i nodes = counts.array() + 1;
  const auto node = [&](int x, int y, int z) { return (z * nodes.y() + y) * nodes.x() + x; };
  TetMesh mesh{Eigen::Matrix3Xd(3, nodes.prod()), Eigen::MatrixXi(4, 6 * counts.prod()), {}};
  for (int z = 0; z <= counts.z(); ++z) {
    for (int y = 0; y <= counts.y(); ++y) {
      for (int x = 0; x <= counts.x(); ++x) {
        mesh.nodes_m.col(node(x, y, z)) =
            Eigen::Array3d(x, y, z) * size_m.array() / counts.cast<double>().array();
      }
    }
  }
  int cell = 0;
  for (int z = 0; z < counts.z(); ++z) {
    for (int y = 0; y < counts.y(); ++y) {
      for (int x = 0; x < counts.x(); ++x) {
        const int first = node(x, y, z);
        const int last = node(x + 1, y + 1, z + 1);
        const int ring[] = {node(x + 1, y, z),     node(x + 1, y + 1, z), node(x, y + 1, z),
                            node(x, y + 1, z + 1), node(x, y, z + 1),     node(x + 1, y, z + 1),
                            node(x + 1, y, z)};
        for (int k = 0; k < 6; ++k) mesh.cells.col(cell++) << first, ring[k], ring[k + 1], last;
      }
    }
  }
  return mesh;
}

}  // namespace palpate::fem
