// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "libs/fem/tet_mesh.hpp"

namespace palpate::fem::mesh_io {

/// Turns cells of negative volume: all of them where no cell is positive, as then the file has the
/// opposite convention; some of them where each then lies on its own side of the faces that it
/// shares, as then they were only written the other way round. Else nothing is turned, because a
/// node lies beyond a face. Returns what was done, for people; empty: nothing.
std::string OrientCells(TetMesh* mesh);

}  // namespace palpate::fem::mesh_io
