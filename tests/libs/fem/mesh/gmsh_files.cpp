// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <cstdint>
#include <tuple>
#include <utility>

#include "libs/core/text.hpp"
#include "tests/libs/fem/mesh/binary.hpp"
#include "tests/libs/fem/mesh/mesh_files.hpp"

namespace palpate::fem::test {

namespace {

/// Writes one .msh file in memory: node k has tag k + 1, all tetrahedra are in the physical volume
/// 7, "soft body", and the triangles in none.
class GmshWriter {
 public:
  GmshWriter(bool binary, bool big_endian) : binary_(binary), big_endian_(big_endian) {}

  std::string Write22(const TetMesh& mesh, const std::vector<int>& surface) {
    Begin("2.2");
    text_ += "$Nodes\n" + std::to_string(mesh.NodeCount()) + "\n";
    for (int node = 0; node < mesh.NodeCount(); ++node) {
      Int(node + 1);
      Position(mesh.nodes_m.col(node));
    }
    EndLine();
    const auto triangles = static_cast<int64_t>(surface.size() / 3);
    text_ += "$EndNodes\n$Elements\n" + std::to_string(triangles + mesh.CellCount()) + "\n";
    Block22(2, 0, surface, 3);
    Block22(mesh.cells.rows() == 4 ? 4 : 11, 7, InGmshOrder(mesh),
            static_cast<size_t>(mesh.cells.rows()));
    EndLine();
    return text_ + "$EndElements\n";
  }

  std::string Write41(const TetMesh& mesh, const std::vector<int>& surface) {
    Begin("4.1");
    text_ += "$Entities\n";
    Entities41();
    text_ += "$EndEntities\n$Nodes\n";
    for (const int64_t value : {int64_t{1}, int64_t{mesh.NodeCount()}, int64_t{1}}) Size(value);
    Size(mesh.NodeCount());
    for (const int value : {3, 1, 0}) Int(value);
    Size(mesh.NodeCount());
    for (int node = 0; node < mesh.NodeCount(); ++node) Size(node + 1);
    for (int node = 0; node < mesh.NodeCount(); ++node) Position(mesh.nodes_m.col(node));
    EndLine();
    text_ += "$EndNodes\n$Elements\n";
    const auto triangles = static_cast<int64_t>(surface.size() / 3);
    Size(2);
    Size(triangles + mesh.CellCount());
    Size(1);
    Size(triangles + mesh.CellCount());
    Block41(2, 2, surface, 3);
    Block41(3, mesh.cells.rows() == 4 ? 4 : 11, InGmshOrder(mesh),
            static_cast<size_t>(mesh.cells.rows()));
    EndLine();
    return text_ + "$EndElements\n";
  }

 private:
  void Begin(const std::string& version) {
    text_ = "$MeshFormat\n" + version + (binary_ ? " 1 8\n" : " 0 8\n");
    if (binary_) text_ += Binary(int32_t{1}, big_endian_) + "\n";
    text_ += "$EndMeshFormat\n$PhysicalNames\n2\n2 3 \"skin\"\n3 7 \"soft body\"\n";
    text_ += "$EndPhysicalNames\n$Comments\nwritten by a test\n$EndComments\n";
  }

  void Block22(int type, int physical, const std::vector<int>& nodes, size_t nodes_each) {
    if (binary_ && !nodes.empty()) {
      for (const int value : {type, static_cast<int>(nodes.size() / nodes_each), 2}) Int(value);
    }
    for (size_t k = 0; k < nodes.size(); k += nodes_each) {
      Int(++element_);
      if (!binary_) Int(type);
      if (!binary_) Int(2);
      Int(physical);
      Int(1);
      for (size_t node = k; node < k + nodes_each; ++node) Int(nodes[node] + 1);
      if (!binary_) EndLine();
    }
  }

  void Entities41() {
    for (const int64_t count : {1, 0, 1, 1}) Size(count);
    Int(1);  // a point
    Position({0.0, 0.0, 0.0});
    Size(0);
    Int(1);  // a surface, in the physical surface 3
    Position({0.0, 0.0, 0.0});
    Position({1.0, 1.0, 1.0});
    Size(1);
    Int(3);
    Size(0);
    Int(1);  // the volume, bounded by the surface
    Position({0.0, 0.0, 0.0});
    Position({1.0, 1.0, 1.0});
    Size(1);
    Int(7);
    Size(1);
    Int(-1);
    EndLine();
  }

  void Block41(int dimension, int type, const std::vector<int>& nodes, size_t nodes_each) {
    for (const int value : {dimension, 1, type}) Int(value);
    Size(static_cast<int64_t>(nodes.size() / nodes_each));
    for (size_t k = 0; k < nodes.size(); k += nodes_each) {
      Size(++element_);
      for (size_t node = k; node < k + nodes_each; ++node) Size(nodes[node] + 1);
    }
  }

  static std::vector<int> InGmshOrder(const TetMesh& mesh) {
    std::vector<int> nodes;
    for (int cell = 0; cell < mesh.CellCount(); ++cell) {
      nodes.insert(nodes.end(), mesh.cells.col(cell).begin(), mesh.cells.col(cell).end());
      if (mesh.cells.rows() == 10) std::swap(nodes[nodes.size() - 2], nodes[nodes.size() - 1]);
    }
    return nodes;
  }

  void Position(const Eigen::Vector3d& position) {
    for (const double value : position) {
      text_ += binary_ ? Binary(value, big_endian_) : FormatNumber(value) + " ";
    }
  }
  void Int(int32_t value) {
    text_ += binary_ ? Binary(value, big_endian_) : std::to_string(value) + " ";
  }
  void Size(int64_t value) {
    text_ +=
        binary_ ? Binary(static_cast<uint64_t>(value), big_endian_) : std::to_string(value) + " ";
  }
  void EndLine() {
    if (text_.back() != '\n' || binary_) text_ += "\n";
  }

  bool binary_;
  bool big_endian_;
  int element_ = 0;
  std::string text_;
};

}  // namespace

std::vector<MeshFile> AllGmshFiles(const TetMesh& mesh, const std::vector<int>& surface) {
  std::vector<MeshFile> files;
  for (const auto& [name, binary, big_endian] :
       {std::tuple("ascii", false, false), std::tuple("binary", true, false),
        std::tuple("binary_big_endian", true, true)}) {
    files.push_back(
        {std::string(name) + "_22.msh", GmshWriter(binary, big_endian).Write22(mesh, surface)});
    files.push_back(
        {std::string(name) + "_41.msh", GmshWriter(binary, big_endian).Write41(mesh, surface)});
  }
  return files;
}

std::string AsciiGmsh22(const TetMesh& mesh) { return GmshWriter(false, false).Write22(mesh, {}); }

std::string AsciiGmsh41(const TetMesh& mesh) { return GmshWriter(false, false).Write41(mesh, {}); }

}  // namespace palpate::fem::test
