// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/fem/tet_mesh.hpp"

namespace palpate::fem {

/// The tet4 mesh with each cell cut into eight, positively oriented where the cell is: four at its
/// corners and four about the shortest diagonal of the octahedron between them (Bey, "Tetrahedral
/// grid refinement", Computing 1995). The nodes of `mesh` keep their numbers; the parts of cell k
/// are cells 8 k to 8 k + 7. Groups are dropped. Of tet4 meshes only.
TetMesh RefineUniformly(const TetMesh& mesh);

}  // namespace palpate::fem
