// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>

namespace palpate::fem::mesh_io {

/// What becomes of a cell of a file.
enum class CellRole {
  kTet4,
  kTet10,
  kLowerDimension,  ///< points, lines, surfaces: passed over
  kRefused,         ///< other volumes, and unknown types
};

struct CellKind {
  CellRole role = CellRole::kRefused;
  int node_count = 0;            ///< 0: any number
  const char* name = "unknown";  ///< for messages
  int dimension = 3;             ///< of kLowerDimension 0 to 2, of Gmsh's types only
};

/// By the numbers of vtkCellType.h. A Lagrange tetrahedron is one of 4 or 10 nodes where it has
/// as many; its nodes have the same order.
CellKind VtkCellKind(int64_t type, size_t node_count);

/// By the numbers of Gmsh's GmshDefines.h.
CellKind GmshCellKind(int64_t type);

}  // namespace palpate::fem::mesh_io
