// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "libs/fem/tet_mesh.hpp"

namespace palpate::fem {

/// Reads a volume mesh; the ending of the file names its format:
///   .vtu  VTK XML UnstructuredGrid: ascii, inline base64, appended (raw or base64), with or
///         without zlib compression, either byte order, header_type UInt32 or UInt64; several
///         Pieces are put one after another (nodes that they share stay doubled).
///   .vtk  VTK legacy UNSTRUCTURED_GRID, versions 2 to 5, ASCII and BINARY.
///   .msh  Gmsh 2.2 and 4.1, ASCII and binary; physical volumes become groups.
/// Kept are tetrahedra of 4 or of 10 nodes, not both in one file. Cells of lower dimension are
/// passed over, other volume cells refused. Lengths are multiplied by `metres_per_unit` (> 0).
///
/// Nodes keep the order of the file (Gmsh: the order of their tags), whether a cell uses them or
/// not. Cells stay oriented as they are, unless not one of them is positively oriented: then the
/// file's convention is the opposite one, all are turned, and `notes` (may be null) says so.
///
/// Throws InputError (file:line:column, or the byte or array in binary data) on anything that is
/// missing, cut off, miscounted, not finite or out of range. Inverted, degenerate and doubled
/// cells are no matter of reading: see ReportMesh and CheckSolvable.
TetMesh ReadMesh(const std::filesystem::path& file, double metres_per_unit,
                 std::vector<std::string>* notes = nullptr);

}  // namespace palpate::fem
