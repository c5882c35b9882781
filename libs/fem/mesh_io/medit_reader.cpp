// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <cctype>
#include <string>

#include "libs/core/text.hpp"
#include "libs/fem/mesh_io/formats.hpp"
#include "libs/fem/mesh_io/limits.hpp"
#include "libs/fem/mesh_io/scanner.hpp"

namespace palpate::fem::mesh_io {

namespace {

/// Reads the text form of Medit's meshes (P. Frey, "Medit: an interactive mesh visualization
/// software", INRIA RT-0253, 2001). References of tetrahedra other than 0 are groups.
class MeditReader {
 public:
  MeditReader(std::string_view bytes, MeshBuilder* builder)
      : bytes_(bytes), scanner_(builder->file(), bytes), builder_(builder) {}

  /// Sections may come in any order: tetrahedra before their vertices are read once these are
  /// known.
  void Read() {
    ReadSections();
    if (!missed_tetrahedra_) return;
    scanner_ = Scanner(builder_->file(), bytes_);
    knows_vertices_ = true;
    ReadSections();
  }

 private:
  void ReadSections() {
    if (Word("MeshVersionFormatted") != "MeshVersionFormatted") {
      scanner_.Fail("is no Medit mesh: it must begin with MeshVersionFormatted");
    }
    scanner_.TextInteger(1, 4, "the version");
    for (auto word = WordOrEnd(); !word.empty() && word != "End"; word = WordOrEnd()) {
      ReadSection(word);
    }
  }

  /// Words behind # are a comment.
  std::string WordOrEnd() {
    std::string word(scanner_.TokenOrEnd());
    while (word.starts_with('#')) {
      if (!scanner_.LastTokenTouchesEnd()) scanner_.Line("a comment");
      word = scanner_.TokenOrEnd();
    }
    return word;
  }

  std::string Word(const char* what) {
    std::string word = WordOrEnd();
    if (word.empty()) scanner_.Fail(std::string("the file ends before ") + what);
    return word;
  }

  void ReadSection(const std::string& name) {
    if (name == "Dimension") {
      if (scanner_.TextInteger(1, 3, "the dimension") != 3) scanner_.Fail("only 3-D is read");
    } else if (name == "Vertices") {
      if (!knows_vertices_) ReadVertices();
    } else if (name.starts_with("Tetrahedra") && builder_->NodeCount() == 0) {
      missed_tetrahedra_ = true;
    } else if (name == "Tetrahedra") {
      ReadTetrahedra(ElementType::kTet4);
    } else if (name == "TetrahedraP2") {
      ReadTetrahedra(ElementType::kTet10);
    } else if (name == "Hexahedra" || name == "Prisms" || name == "Pyramids") {
      if (scanner_.TextInteger(0, kMaxCount, "the number of cells") > 0) {
        scanner_.Fail(name + " are not read, only tetrahedra of 4 or 10 nodes");
      }
    } else if (std::isalpha(static_cast<unsigned char>(name.front())) == 0) {
      scanner_.Fail("expected the name of a section, not '" + Excerpt(name) + "'");
    }
    // The numbers of a section that is no matter of the mesh are passed over one by one.
    while (name != "Dimension" && NumberFollows()) scanner_.Token("a number");
  }

  bool NumberFollows() const {
    const std::string_view rest = scanner_.Peek();
    return !rest.empty() && (std::isdigit(static_cast<unsigned char>(rest.front())) != 0 ||
                             rest.front() == '-' || rest.front() == '+' || rest.front() == '.');
  }

  void ReadVertices() {
    const int64_t count = scanner_.TextInteger(0, kMaxCount, "the number of vertices");
    scanner_.CheckRoom(count, 8, "vertices");
    for (int64_t k = 0; k < count; ++k) {
      const double x = scanner_.Real(ScalarType::kFloat64, "a coordinate");
      const double y = scanner_.Real(ScalarType::kFloat64, "a coordinate");
      const double z = scanner_.Real(ScalarType::kFloat64, "a coordinate");
      scanner_.TextInteger(-kMaxCount, kMaxCount, "a reference");
      builder_->AddNode(x, y, z);
    }
  }

  void ReadTetrahedra(ElementType type) {
    std::array<int64_t, 10> nodes{};
    const auto size = static_cast<size_t>(type);
    const int64_t count = scanner_.TextInteger(0, kMaxCount, "the number of tetrahedra");
    scanner_.CheckRoom(count, 2 * size, "tetrahedra");
    if (count > 0 && type == ElementType::kTet4) RefuseTenNodes();
    for (int64_t k = 0; k < count; ++k) {
      for (size_t n = 0; n < size; ++n) {
        nodes[n] = scanner_.TextInteger(1, builder_->NodeCount(), "a vertex of a tetrahedron") - 1;
      }
      const int64_t reference = scanner_.TextInteger(-kMaxCount, kMaxCount, "a reference");
      const int tet = builder_->AddTet(type, std::span(nodes).first(size));
      if (reference != 0) {
        builder_->AddToGroup(builder_->GroupNamed(std::to_string(reference)), tet);
      }
    }
  }

  /// Gmsh writes tetrahedra of ten nodes under the keyword of four.
  void RefuseTenNodes() const {
    const std::string_view rest = scanner_.Peek();
    const std::string_view line = rest.substr(0, rest.find('\n'));
    int numbers = 0;
    for (std::size_t k = 0; k < line.size(); ++k) {
      const auto is_space = [&](std::size_t i) {
        return std::isspace(static_cast<unsigned char>(line[i])) != 0;
      };
      numbers += !is_space(k) && (k == 0 || is_space(k - 1)) ? 1 : 0;
    }
    if (numbers == 10 + 1) {
      scanner_.Fail(
          "ten nodes and a reference under 'Tetrahedra', which has four: save the mesh as .msh or "
          ".vtu, or with linear elements");
    }
  }

  std::string_view bytes_;
  Scanner scanner_;
  MeshBuilder* builder_;
  bool missed_tetrahedra_ = false;
  bool knows_vertices_ = false;
};

}  // namespace

void ReadMedit(std::string_view bytes, MeshBuilder* builder) { MeditReader(bytes, builder).Read(); }

}  // namespace palpate::fem::mesh_io
