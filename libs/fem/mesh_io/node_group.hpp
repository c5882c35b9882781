// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

namespace palpate::fem {

/// What a mesh file names that is no volume: a physical surface, curve or point of Gmsh, a node
/// set of Abaqus.
struct NodeGroup {
  std::string name;   ///< or its number where it has no name
  int dimension = 0;  ///< 0: points, 1: lines, 2: surfaces
  /// Node indices of each element, corners first; of dimension 0 one node each.
  std::vector<std::vector<int>> elements;
};

}  // namespace palpate::fem
