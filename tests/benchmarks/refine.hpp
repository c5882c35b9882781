// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/fem/tet_mesh.hpp"

namespace palpate::benchmarks {

/// The tet4 mesh with each cell cut into eight, positively oriented where the cell is: four at its
/// corners and four about the shortest diagonal of the octahedron between them (Bey, "Tetrahedral
/// grid refinement", Computing 1995). The nodes of `mesh` keep their numbers. Of tet4 meshes only.
fem::TetMesh RefineUniformly(const fem::TetMesh& mesh);

}  // namespace palpate::benchmarks
