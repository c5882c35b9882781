// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/mesh_io/read_mesh.hpp"

#include <cmath>
#include <string_view>
#include <system_error>

#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/fem/mesh_io/formats.hpp"
#include "libs/fem/mesh_io/mesh_builder.hpp"
#include "libs/fem/mesh_io/mesh_kind.hpp"

namespace palpate::fem {

namespace {

std::string LoadBytes(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    throw InputError(file.string() + ": mesh file not found");
  }
  if (!std::filesystem::is_regular_file(file, error)) {
    throw InputError(file.string() + ": not a regular file");
  }
  std::string bytes = ReadFile(file);
  if (bytes.empty()) throw InputError(file.string() + ": the file is empty");
  return bytes;
}

using Reader = void (*)(std::string_view bytes, mesh_io::MeshBuilder* builder);

Reader ReaderOf(MeshKind kind) {
  switch (kind) {
    case MeshKind::kVtu: return mesh_io::ReadVtu;
    case MeshKind::kLegacyVtk: return mesh_io::ReadLegacyVtk;
    case MeshKind::kGmsh: return mesh_io::ReadGmsh;
    case MeshKind::kAbaqus: return mesh_io::ReadAbaqus;
    case MeshKind::kMedit: return mesh_io::ReadMedit;
    case MeshKind::kNone: break;
  }
  return nullptr;
}

}  // namespace

TetMesh ReadMesh(const std::filesystem::path& file, double metres_per_unit,
                 std::vector<std::string>* notes, std::vector<NodeGroup>* node_groups) {
  PALPATE_CHECK(std::isfinite(metres_per_unit) && metres_per_unit > 0.0, metres_per_unit);
  constexpr std::string_view kUtf8Mark = "\xEF\xBB\xBF";
  const std::string loaded = LoadBytes(file);
  std::string_view bytes = loaded;
  if (bytes.starts_with(kUtf8Mark)) bytes.remove_prefix(kUtf8Mark.size());
  const Reader read = ReaderOf(KindOfMesh(file, bytes));
  if (read == nullptr) {
    throw InputError(file.string() + ": unknown mesh format '" + file.extension().string() +
                     "' (known: " + MeshEndings() + ")");
  }
  mesh_io::MeshBuilder builder(file.string());
  if (node_groups != nullptr) builder.KeepNodeGroups();
  read(bytes, &builder);
  if (node_groups != nullptr) *node_groups = builder.TakeNodeGroups();
  return std::move(builder).Finish(metres_per_unit, notes);
}

}  // namespace palpate::fem
