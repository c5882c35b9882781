// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/mesh_io/mesh_kind.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "libs/core/check.hpp"
#include "libs/fem/mesh_io/limits.hpp"

namespace palpate::fem {

namespace {

constexpr std::array<std::pair<std::string_view, MeshKind>, 5> kEndings = {{
    {".vtu", MeshKind::kVtu},
    {".vtk", MeshKind::kLegacyVtk},
    {".msh", MeshKind::kGmsh},
    {".inp", MeshKind::kAbaqus},
    {".mesh", MeshKind::kMedit},
}};

std::string LowerCaseEnding(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return ending;
}

MeshKind KindByEnding(const std::filesystem::path& file) {
  const std::string ending = LowerCaseEnding(file);
  for (const auto& [known, kind] : kEndings) {
    if (known == ending) return kind;
  }
  return MeshKind::kNone;
}

/// XML is a mesh where it is VTK's.
bool IsVtkXml(std::string_view bytes) {
  return bytes.starts_with('<') && bytes.find("<VTKFile") != std::string_view::npos;
}

}  // namespace

MeshKind KindOfMesh(const std::filesystem::path& file, std::string_view bytes) {
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
  bytes.remove_prefix(std::min(bytes.find_first_not_of(mesh_io::kWhiteSpace), bytes.size()));
  if (IsVtkXml(bytes)) return MeshKind::kVtu;
  if (bytes.starts_with("# vtk DataFile")) return MeshKind::kLegacyVtk;
  if (bytes.starts_with("$MeshFormat") || bytes.starts_with("$Comments")) return MeshKind::kGmsh;
  if (bytes.starts_with("MeshVersionFormatted")) return MeshKind::kMedit;
  return KindByEnding(file);
}

std::string ToString(MeshKind kind) {
  switch (kind) {
    case MeshKind::kVtu: return "VTK XML";
    case MeshKind::kLegacyVtk: return "VTK legacy";
    case MeshKind::kGmsh: return "Gmsh";
    case MeshKind::kAbaqus: return "Abaqus";
    case MeshKind::kMedit: return "Medit";
    case MeshKind::kNone: break;
  }
  PALPATE_CHECK(false, static_cast<int>(kind));
  return {};
}

std::string MeshEndings() {
  std::string endings;
  for (const auto& [ending, kind] : kEndings) {
    endings += (endings.empty() ? "" : ", ") + std::string(ending);
  }
  return endings;
}

}  // namespace palpate::fem
