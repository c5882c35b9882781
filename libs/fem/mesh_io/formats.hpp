// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string_view>

#include "libs/fem/mesh_io/mesh_builder.hpp"

namespace palpate::fem::mesh_io {

/// One function for each format: the whole file as bytes in, nodes and cells into `builder` (which
/// knows the file's name). All throw InputError.
void ReadVtu(std::string_view bytes, MeshBuilder* builder);
void ReadLegacyVtk(std::string_view bytes, MeshBuilder* builder);
void ReadGmsh(std::string_view bytes, MeshBuilder* builder);
void ReadAbaqus(std::string_view bytes, MeshBuilder* builder);
void ReadMedit(std::string_view bytes, MeshBuilder* builder);

}  // namespace palpate::fem::mesh_io
