// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace palpate::fem {

/// Mesh formats, told apart by the first bytes of a file, and by its ending where these say
/// nothing.
enum class MeshKind {
  kNone,
  kVtu,        ///< VTK XML
  kLegacyVtk,  ///< "# vtk DataFile"
  kGmsh,
  kAbaqus,  ///< .inp
  kMedit,   ///< .mesh
};

/// `bytes`: the beginning of the file, 1 kB or all of it.
MeshKind KindOfMesh(const std::filesystem::path& file, std::string_view bytes);

/// "VTK XML", ... for people.
std::string ToString(MeshKind kind);

/// ".vtu, .vtk, ..." for messages.
std::string MeshEndings();

}  // namespace palpate::fem
