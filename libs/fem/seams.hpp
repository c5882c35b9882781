// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "libs/fem/tet_mesh.hpp"

namespace palpate::fem {

/// Joins parts of a mesh whose faces lie on each other, each with nodes of its own: cells then name
/// the node of the lower number. Two boundary faces lie on each other where their corners do,
/// within a millionth of the mesh's diagonal. Nodes that meet in a point or along an edge only stay
/// apart. No node is removed: the returned ones, rising, are of no cell afterwards.
std::vector<int> JoinSeams(TetMesh* mesh);

}  // namespace palpate::fem
