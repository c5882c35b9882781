// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace palpate::fem {

/// Corner nodes first, then the mid-edge nodes of edges 01, 12, 02, 03, 13, 23 (VTK_QUADRATIC_
/// TETRA; Gmsh swaps the last two, which the reader corrects).
enum class ElementType { kTet4 = 4, kTet10 = 10 };

/// Cells under a common name: a physical volume, an element set, a value of cell data.
struct CellGroup {
  std::string name;
  std::vector<int> cells;  ///< rising
  bool operator==(const CellGroup&) const = default;
};

/// A volume mesh at rest. Node numbers are those of the file; mid-edge nodes that we make
/// ourselves follow after the last of them.
struct TetMesh {
  Eigen::Matrix3Xd nodes_m;  ///< [3 x n] rest positions, robot frame, m
  Eigen::MatrixXi cells;     ///< [4 or 10 x m] node indices, positively oriented

  /// Groups that the file names, each with a cell at least. They may overlap.
  std::vector<CellGroup> groups;

  int NodeCount() const { return static_cast<int>(nodes_m.cols()); }
  int CellCount() const { return static_cast<int>(cells.cols()); }
  ElementType element_type() const { return static_cast<ElementType>(cells.rows()); }
};

/// The mesh with a node on the middle of every edge of a tet4 mesh, numbered after the corners in
/// the order in which the cells name the edges. A tet10 mesh comes back as it is.
TetMesh MakeQuadratic(const TetMesh& mesh);

}  // namespace palpate::fem
