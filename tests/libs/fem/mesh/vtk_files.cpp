// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <cstdint>

#include "libs/core/text.hpp"
#include "tests/libs/fem/mesh/binary.hpp"
#include "tests/libs/fem/mesh/mesh_files.hpp"

namespace palpate::fem::test {

namespace {

/// Writes one legacy .vtk file in memory; binary ones are big endian.
class VtkWriter {
 public:
  VtkWriter(bool version_5, bool binary) : version_5_(version_5), binary_(binary) {}

  std::string Write(const TetMesh& mesh, const std::vector<int>& surface) {
    text_ = std::string("# vtk DataFile Version ") + (version_5_ ? "5.1" : "3.0") + "\na cube\n" +
            (binary_ ? "BINARY" : "ASCII") + "\nDATASET UNSTRUCTURED_GRID\n" +
            "FIELD FieldData 1\nTIME 1 1 double\n";
    Real(0.5);
    text_ += "\nPOINTS " + std::to_string(mesh.NodeCount()) + " double\n";
    for (const double value : mesh.nodes_m.reshaped()) Real(value);
    text_ += version_5_ ? "\nMETADATA\nINFORMATION 0\n\n" : "\n";
    std::vector<std::vector<int64_t>> cells;
    for (size_t k = 0; k < surface.size(); k += 3) {
      cells.push_back({surface[k], surface[k + 1], surface[k + 2]});
    }
    for (int cell = 0; cell < mesh.CellCount(); ++cell) {
      cells.emplace_back(mesh.cells.col(cell).begin(), mesh.cells.col(cell).end());
    }
    version_5_ ? OffsetCells(cells) : PackedCells(cells);
    text_ += "\nCELL_TYPES " + std::to_string(cells.size()) + "\n";
    for (const auto& cell : cells) Int<int32_t>(cell.size() == 3 ? 5 : cell.size() == 4 ? 10 : 24);
    return text_ + "\n";
  }

 private:
  void PackedCells(const std::vector<std::vector<int64_t>>& cells) {
    size_t size = 0;
    for (const auto& cell : cells) size += cell.size() + 1;
    text_ += "CELLS " + std::to_string(cells.size()) + " " + std::to_string(size) + "\n";
    for (const auto& cell : cells) {
      Int<int32_t>(static_cast<int64_t>(cell.size()));
      for (const int64_t node : cell) Int<int32_t>(node);
    }
  }

  void OffsetCells(const std::vector<std::vector<int64_t>>& cells) {
    size_t size = 0;
    for (const auto& cell : cells) size += cell.size();
    text_ += "CELLS " + std::to_string(cells.size() + 1) + " " + std::to_string(size) +
             "\nOFFSETS vtktypeint64\n";
    int64_t offset = 0;
    Int<int64_t>(offset);
    for (const auto& cell : cells) Int<int64_t>(offset += static_cast<int64_t>(cell.size()));
    text_ += "\nCONNECTIVITY vtktypeint64\n";
    for (const auto& cell : cells) {
      for (const int64_t node : cell) Int<int64_t>(node);
    }
  }

  void Real(double value) { text_ += binary_ ? Binary(value, true) : FormatNumber(value) + " "; }

  template <typename Value>
  void Int(int64_t value) {
    text_ += binary_ ? Binary(static_cast<Value>(value), true) : std::to_string(value) + "\n";
  }

  bool version_5_;
  bool binary_;
  std::string text_;
};

}  // namespace

std::vector<MeshFile> AllVtkFiles(const TetMesh& mesh, const std::vector<int>& surface) {
  return {{"ascii_3.vtk", VtkWriter(false, false).Write(mesh, surface)},
          {"binary_3.vtk", VtkWriter(false, true).Write(mesh, surface)},
          {"ascii_5.vtk", VtkWriter(true, false).Write(mesh, surface)},
          {"binary_5.vtk", VtkWriter(true, true).Write(mesh, surface)}};
}

std::string AsciiVtk(const TetMesh& mesh) { return VtkWriter(false, false).Write(mesh, {}); }

}  // namespace palpate::fem::test
