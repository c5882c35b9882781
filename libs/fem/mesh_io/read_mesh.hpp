// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "libs/fem/mesh_io/node_group.hpp"
#include "libs/fem/tet_mesh.hpp"

namespace palpate::fem {

/// Reads a volume mesh; its first bytes name its format, and its ending where these say nothing:
///   .vtu   VTK XML UnstructuredGrid: ascii, inline base64, appended (raw or base64), with or
///          without zlib, LZ4 or LZMA compression, either byte order, header_type UInt32 or UInt64;
///          several Pieces are put one after another (nodes that they share stay doubled).
///   .vtk   VTK legacy UNSTRUCTURED_GRID, versions 2 to 5, ASCII and BINARY.
///   .msh   Gmsh 2.0 to 2.2, 4.0 and 4.1, ASCII and binary, also in partitions.
///   .inp   Abaqus and CalculiX: *NODE, *ELEMENT of type C3D4 and C3D10, *ELSET; one part.
///   .mesh  Medit, as text.
/// Kept are tetrahedra of 4 or of 10 nodes, not both in one file. Cells of lower dimension are
/// passed over, other volume cells refused. Lengths are multiplied by `metres_per_unit` (> 0).
/// Physical volumes, element sets, references and cell data of whole numbers become groups.
///
/// Nodes keep the order of the file (Gmsh: the order of their tags), whether a cell uses them or
/// not. Cells that are oriented the other way round are turned where the mesh is sound then, and
/// `notes` (may be null) says so. `node_groups` (may be null) takes what the file names besides
/// volumes: physical surfaces, curves and points, and *NSET.
///
/// Throws InputError (file:line:column, or the byte or array in binary data) on anything that is
/// missing, cut off, miscounted, not finite or out of range. Inverted, degenerate and doubled
/// cells are no matter of reading: see ReportMesh and CheckSolvable.
TetMesh ReadMesh(const std::filesystem::path& file, double metres_per_unit,
                 std::vector<std::string>* notes = nullptr,
                 std::vector<NodeGroup>* node_groups = nullptr);

}  // namespace palpate::fem
