// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <tinyxml2.h>

#include <bit>
#include <span>
#include <string>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/fem/mesh_io/formats.hpp"
#include "libs/fem/mesh_io/limits.hpp"
#include "libs/fem/mesh_io/vtu_array.hpp"
#include "libs/fem/mesh_io/vtu_text.hpp"

namespace palpate::fem::mesh_io {

namespace {

using tinyxml2::XMLElement;

[[noreturn]] void FailAt(const XMLElement& element, const VtuStorage& storage,
                         const std::string& message) {
  throw InputError(SourceLocation{storage.file, element.GetLineNum(), 0},
                   "<" + std::string(element.Name()) + "> " + message);
}

/// The file without its numbers, which go to `storage`; AppendedData are no XML where they are raw.
std::string CutAppendedData(std::string_view bytes, VtuStorage* storage) {
  const size_t element = bytes.find("<AppendedData");
  if (element == std::string_view::npos) return CutArrayTexts(bytes, &storage->texts);
  const size_t tag_end = bytes.find('>', element);
  const size_t underscore = bytes.find('_', tag_end);
  const size_t closing = bytes.rfind("</AppendedData");
  if (tag_end == std::string_view::npos || underscore == std::string_view::npos ||
      closing == std::string_view::npos || closing <= underscore) {
    throw InputError(storage->file + ": <AppendedData> is not complete; the file is cut off");
  }
  storage->appended = bytes.substr(underscore + 1, closing - underscore - 1);
  return CutArrayTexts(bytes.substr(0, tag_end + 1), &storage->texts) +
         std::string(bytes.substr(closing));
}

std::string_view AttributeOr(const XMLElement& element, const char* name, const char* fallback) {
  const char* value = element.Attribute(name);
  return value == nullptr ? fallback : value;
}

/// True for `second`, false for `first`, InputError for anything else.
bool IsSecondOf(const XMLElement& element, const VtuStorage& storage, const char* attribute,
                const char* first, const char* second) {
  const std::string_view value = AttributeOr(element, attribute, first);
  if (value == first || value == second) return value == second;
  FailAt(element, storage,
         std::string(attribute) + " '" + std::string(value) + "' is not read (only " +
             (*first == '\0' ? "none" : first) + " and " + second + ")");
}

Packing ReadPacking(const XMLElement& root, const VtuStorage& storage) {
  const std::string_view name = AttributeOr(root, "compressor", "");
  if (name.empty()) return Packing::kNone;
  if (name == "vtkZLibDataCompressor") return Packing::kZlib;
  if (name == "vtkLZ4DataCompressor") return Packing::kLz4;
  if (name == "vtkLZMADataCompressor") return Packing::kLzma;
  FailAt(root, storage, "compressor '" + Excerpt(name) + "' is not read");
}

void ReadStorage(const XMLElement& root, VtuStorage* storage) {
  const std::string_view type = AttributeOr(root, "type", "");
  if (type == "PUnstructuredGrid") {
    FailAt(root, *storage, "only lists the pieces of a mesh: write it as one file (.vtu)");
  }
  if (type != "UnstructuredGrid") {
    FailAt(root, *storage, "is of type '" + Excerpt(type) + "', not UnstructuredGrid");
  }
  const bool big_endian = IsSecondOf(root, *storage, "byte_order", "LittleEndian", "BigEndian");
  storage->swap = big_endian != (std::endian::native == std::endian::big);
  storage->wide_header = IsSecondOf(root, *storage, "header_type", "UInt32", "UInt64");
  storage->packing = ReadPacking(root, *storage);
  if (const XMLElement* appended = root.FirstChildElement("AppendedData")) {
    storage->appended_base64 = !IsSecondOf(*appended, *storage, "encoding", "base64", "raw");
  }
}

const XMLElement& Child(const XMLElement& parent, const VtuStorage& storage, const char* name) {
  const XMLElement* child = parent.FirstChildElement(name);
  if (child == nullptr) FailAt(parent, storage, "has no <" + std::string(name) + ">");
  return *child;
}

const XMLElement& NamedArray(const XMLElement& parent, const VtuStorage& storage,
                             std::string_view name) {
  for (const XMLElement* array = parent.FirstChildElement("DataArray"); array != nullptr;
       array = array->NextSiblingElement("DataArray")) {
    if (AttributeOr(*array, "Name", "") == name) return *array;
  }
  FailAt(parent, storage, "has no DataArray named '" + std::string(name) + "'");
}

int64_t Count(const XMLElement& piece, const VtuStorage& storage, const char* name) {
  int64_t count = -1;
  if (piece.QueryInt64Attribute(name, &count) != tinyxml2::XML_SUCCESS || count < 0 ||
      count > kMaxCount) {
    FailAt(piece, storage,
           std::string("needs an attribute '") + name + "', an integer from 0 to " +
               std::to_string(kMaxCount));
  }
  return count;
}

void ReadPoints(const XMLElement& piece, const VtuStorage& storage, int64_t count,
                MeshBuilder* builder) {
  const XMLElement& array = Child(Child(piece, storage, "Points"), storage, "DataArray");
  if (AttributeOr(array, "NumberOfComponents", "3") != "3") {
    FailAtArray(array, storage, "must have 3 components");
  }
  const LargeVector<double> xyz = ReadRealArray(array, storage, 3 * count);
  builder->ExpectNodes(count);
  for (size_t k = 0; k < xyz.size(); k += 3) builder->AddNode(xyz[k], xyz[k + 1], xyz[k + 2]);
}

void ReadCells(const XMLElement& piece, const VtuStorage& storage, int64_t count,
               int64_t first_node, MeshBuilder* builder) {
  const XMLElement& cells = Child(piece, storage, "Cells");
  const XMLElement& offset_array = NamedArray(cells, storage, "offsets");
  const LargeVector<int64_t> types =
      ReadIntegerArray(NamedArray(cells, storage, "types"), storage, count);
  const LargeVector<int64_t> offsets = ReadIntegerArray(offset_array, storage, count);
  int64_t previous = 0;
  for (const int64_t offset : offsets) {
    if (offset < previous || offset > kMaxCount) FailAtArray(offset_array, storage, "must rise");
    previous = offset;
  }
  LargeVector<int64_t> nodes =
      ReadIntegerArray(NamedArray(cells, storage, "connectivity"), storage, previous);
  for (int64_t& node : nodes) {
    if (node < 0 || node >= builder->NodeCount() - first_node) {
      FailAtArray(NamedArray(cells, storage, "connectivity"), storage,
                  "node index " + std::to_string(node) + " is outside 0 to " +
                      std::to_string(builder->NodeCount() - first_node - 1));
    }
    node += first_node;
  }
  builder->ExpectCells(count, previous);
  size_t start = 0;
  for (size_t cell = 0; cell < types.size(); ++cell) {
    const size_t end = static_cast<size_t>(offsets[cell]);
    builder->AddVtkCell(types[cell], std::span(nodes).subspan(start, end - start));
    start = end;
  }
}

/// Arrays of whole numbers name groups of cells; the others are no matter of the mesh.
/// Some programs write region numbers as reals. Reals that are none, such as a field with NaN, are
/// no matter of the mesh.
std::vector<double> CellValues(const XMLElement& array, const VtuStorage& storage, int64_t count) {
  if (IsIntegerArray(array)) {
    const LargeVector<int64_t> integers = ReadIntegerArray(array, storage, count);
    return {integers.begin(), integers.end()};
  }
  try {
    const LargeVector<double> reals = ReadRealArray(array, storage, count);
    return {reals.begin(), reals.end()};
  } catch (const InputError&) {
    return {};
  }
}

void ReadCellData(const XMLElement& piece, const VtuStorage& storage, int64_t count,
                  MeshBuilder* builder) {
  const XMLElement* data = piece.FirstChildElement("CellData");
  if (data == nullptr) return;
  for (const XMLElement* array = data->FirstChildElement("DataArray"); array != nullptr;
       array = array->NextSiblingElement("DataArray")) {
    if (AttributeOr(*array, "NumberOfComponents", "1") != "1") continue;
    builder->AddVtkCellData(std::string(AttributeOr(*array, "Name", "cells")),
                            builder->VtkCellCount() - count, CellValues(*array, storage, count));
  }
}

}  // namespace

void ReadVtu(std::string_view bytes, MeshBuilder* builder) {
  VtuStorage storage;
  storage.file = builder->file();
  const std::string xml = CutAppendedData(bytes, &storage);
  tinyxml2::XMLDocument document;
  if (document.Parse(xml.data(), xml.size()) != tinyxml2::XML_SUCCESS) {
    throw InputError(SourceLocation{storage.file, document.ErrorLineNum(), 0},
                     std::string("is damaged or cut off: ") + document.ErrorName());
  }
  const XMLElement* root = document.RootElement();
  if (root == nullptr || std::string_view(root->Name()) != "VTKFile") {
    throw InputError(storage.file + ": is no VTK XML file: its root must be <VTKFile>");
  }
  ReadStorage(*root, &storage);
  const XMLElement& grid = Child(*root, storage, "UnstructuredGrid");
  for (const XMLElement* piece = &Child(grid, storage, "Piece"); piece != nullptr;
       piece = piece->NextSiblingElement("Piece")) {
    const int64_t first_node = builder->NodeCount();
    ReadPoints(*piece, storage, Count(*piece, storage, "NumberOfPoints"), builder);
    const int64_t cells = Count(*piece, storage, "NumberOfCells");
    ReadCells(*piece, storage, cells, first_node, builder);
    ReadCellData(*piece, storage, cells, builder);
  }
}

}  // namespace palpate::fem::mesh_io
