// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/new_robot/source_mesh.hpp"

#include <algorithm>
#include <cctype>
#include <regex>

#include "components/palpate/info/file_kind.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/text.hpp"
#include "libs/fem/mesh_io/mesh_kind.hpp"
#include "libs/fem/mesh_io/read_mesh.hpp"
#include "libs/fem/mesh_report.hpp"
#include "libs/fem/seams.hpp"

namespace palpate::command {

namespace {

namespace fs = std::filesystem;

std::string EndingOf(const fs::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

/// The commands that make tetrahedra of a file without them; empty where none is known.
std::string MeshCommands(const fs::path& file) {
  const std::string ending = EndingOf(file);
  const std::string stem = file.stem().string();
  const std::string name = file.filename().string();
  if (ending == ".stl" || ending == ".ply" || ending == ".obj" || ending == ".off") {
    return "with Gmsh, where the surface is closed, put these two lines in " + stem +
           ".geo:\n  Merge \"" + name +
           "\"; ClassifySurfaces{40 * Pi / 180, 1, 1}; CreateGeometry;\n"
           "  Surface Loop(1) = Surface{:}; Volume(1) = {1};\nthen run, with elements of at most "
           "SIZE:\n  gmsh -3 " +
           stem + ".geo -clmax SIZE -format msh41 -o " + stem + ".msh\n  palpate new-robot " +
           stem + ".msh";
  }
  if (ending == ".step" || ending == ".stp" || ending == ".iges" || ending == ".igs" ||
      ending == ".brep" || ending == ".geo") {
    return "with Gmsh, with elements of at most SIZE:\n  gmsh -3 " + name +
           " -clmax SIZE -format msh41 -o " + stem + ".msh\n  palpate new-robot " + stem + ".msh";
  }
  return "";
}

void RefuseOtherFiles(const fs::path& file) {
  if (!fs::exists(file)) throw InputError(SourceLocation{file.string()}, "mesh file not found");
  if (fs::is_directory(file)) {
    throw InputError(SourceLocation{file.string()}, "is a folder; give a mesh file");
  }
  const FileKind kind = KindOf(file);
  if (kind.family == FileKind::Family::kMesh) return;
  const std::string what = kind.family == FileKind::Family::kSettings
                               ? "is YAML: a robot file needs no new-robot; palpate info checks it"
                               : (kind.name.empty() ? "is of no kind that is known"
                                                    : "is no mesh of tetrahedra but: " + kind.name);
  const std::string commands = MeshCommands(file);
  throw InputError(
      SourceLocation{file.string()},
      what + (commands.empty() ? "; a mesh of tetrahedra ends in " + fem::MeshEndings()
                               : ". A robot needs tetrahedra inside the body: " + commands));
}

/// A comment such as "** UNITS: mm", "lengths in mm" among the first lines of a text.
void FindUnitComment(const fs::path& file, SourceMesh* source) {
  constexpr size_t kHead = 4096;
  const std::string head = ReadFile(file).substr(0, kHead);
  static const std::regex kSays(
      R"(((?:units?|lengths?|coordinates?)\b[^\n]{0,20}[\s:=(\[])(mm|cm|m|millimet(?:er|re)s?|centimet(?:er|re)s?|met(?:er|re)s?)\b)",
      std::regex::icase);
  std::smatch found;
  if (!std::regex_search(head, found, kSays)) return;
  std::string word = found[2].str();
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  source->unit = word == "mm" || word.starts_with("milli")   ? "mm"
                 : word == "cm" || word.starts_with("centi") ? "cm"
                                                             : "m";
  source->unit_comment = Excerpt(found.str());
}

}  // namespace

std::vector<std::string> WordsOfName(const std::string& name) {
  std::vector<std::string> words(1);
  char before = '_';
  for (const char letter : name) {
    const auto c = static_cast<unsigned char>(letter);
    const auto b = static_cast<unsigned char>(before);
    const bool is_letter = std::isalpha(c) != 0, is_digit = std::isdigit(c) != 0;
    const bool begins = (std::isupper(c) != 0 && std::islower(b) != 0) ||
                        (is_digit != (std::isdigit(b) != 0)) || (!is_letter && !is_digit);
    if (begins && !words.back().empty()) words.emplace_back();
    if (is_letter || is_digit) words.back() += static_cast<char>(std::tolower(c));
    before = letter;
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

bool NamesOneOf(const std::string& name, const std::vector<std::string>& words) {
  const std::vector<std::string> own = WordsOfName(name);
  return std::any_of(own.begin(), own.end(), [&](const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  });
}

SourceMesh ReadSourceMesh(const fs::path& file) {
  RefuseOtherFiles(file);
  SourceMesh source;
  source.file = file;
  source.mesh = fem::ReadMesh(file, 1.0, &source.notes, &source.groups);
  fem::JoinSeams(&source.mesh);
  fem::CheckSolvable(source.mesh, fem::ReportMesh(source.mesh), file.string(),
                     fem::Pieces::kSeveralAllowed);
  FindUnitComment(file, &source);
  return source;
}

}  // namespace palpate::command
