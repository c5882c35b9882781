// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "libs/fem/mesh_io/node_group.hpp"
#include "libs/fem/tet_mesh.hpp"

namespace palpate::command {

/// A mesh file before its unit is known.
struct SourceMesh {
  std::filesystem::path file;
  fem::TetMesh mesh;                    ///< lengths in the unit of the file; seams joined
  std::vector<fem::NodeGroup> groups;   ///< named points, lines, surfaces and node sets
  std::string unit = {};                ///< m, cm or mm where a comment of the file says it
  std::string unit_comment = {};        ///< that comment
  std::vector<std::string> notes = {};  ///< of reading
};

/// Throws InputError: a file that is not there or damaged, a mesh that cannot be solved, and, with
/// the commands that make tetrahedra of it, a surface or a drawing.
SourceMesh ReadSourceMesh(const std::filesystem::path& file);

/// Whether `name` holds one of `words` as a word of its own: "fixed_face", "FixedFace", "fixed-1".
bool NamesOneOf(const std::string& name, const std::vector<std::string>& words);

/// The words of a name in lower case: "leftFoot_2" is left, foot, 2.
std::vector<std::string> WordsOfName(const std::string& name);

}  // namespace palpate::command
