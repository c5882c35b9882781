// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "libs/fem/tet_mesh.hpp"

namespace palpate::fem {

/// What one wants to know of a mesh before anything is computed on it. Lists hold indices into
/// the mesh, rising. Cells that name a node which does not exist count in `bad_index_cells` and
/// nowhere else.
struct MeshReport {
  int node_count = 0;
  int cell_count = 0;
  int nodes_per_cell = 0;
  double volume_m3 = 0.0;  ///< sum over the cells, inverted ones negative; exact for curved tet10

  /// Mean-ratio quality 12 (3 V)^(2/3) / sum of squared edge lengths, in (0, 1], 1 for the regular
  /// tetrahedron, 0 for a flat one; of the corner tetrahedron where the cell is a tet10 (Liu & Joe,
  /// "On the shape of tetrahedra from bisection", Math. Comp. 1994). Least one, and its cell.
  double worst_quality = 1.0;
  int worst_cell = -1;

  Eigen::Vector3d min_m = Eigen::Vector3d::Zero();  ///< bounding box of the nodes that cells use
  Eigen::Vector3d max_m = Eigen::Vector3d::Zero();

  int boundary_triangles = 0;  ///< faces of one cell alone
  int overshared_faces = 0;    ///< faces of more than two cells: cells overlap there
  /// Edges of the boundary surface that are not shared by exactly two of its triangles: there the
  /// surface is no manifold.
  int free_edges = 0;
  int pieces = 0;  ///< bodies without a common node: each must be held
  int parts = 0;   ///< bodies without a common face; more than pieces: some hang by an edge or node

  std::vector<int> inverted_cells;    ///< negative volume, or det J <= 0 at a point of integration
  std::vector<int> degenerate_cells;  ///< flat: quality of 1e-6 or less whatever the sign
  std::vector<int> duplicate_cells;   ///< corners exactly where an earlier cell has them
  std::vector<int> bad_index_cells;
  std::vector<int> duplicate_nodes;  ///< exactly where an earlier node is
  std::vector<int> unused_nodes;     ///< of no cell: they stay, and must be held
  std::vector<int> nonfinite_nodes;
};

/// Never throws on bad meshes; n log n in the number of cells.
MeshReport ReportMesh(const TetMesh& mesh);

/// One screen of text, lines of less than 100 characters.
std::string ToText(const MeshReport& report);

enum class Pieces { kOneOnly, kSeveralAllowed };

/// Throws InputError naming `file` and the first offenders where the mesh cannot be solved: no
/// cells, node indices out of range, coordinates not finite, inverted, degenerate or duplicate
/// cells, faces shared by more than two cells, and, unless allowed, more than one piece. Allow
/// several where each is known to be held. Unused nodes are no reason: they keep their numbers.
void CheckSolvable(const TetMesh& mesh, const MeshReport& report, const std::string& file,
                   Pieces pieces = Pieces::kOneOnly);

}  // namespace palpate::fem
