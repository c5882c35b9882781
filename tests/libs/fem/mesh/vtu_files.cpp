// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <cstdint>
#include <initializer_list>

#include "libs/core/text.hpp"
#include "libs/fem/mesh_io/base64.hpp"
#include "libs/fem/mesh_io/zlib_stream.hpp"
#include "tests/libs/fem/mesh/binary.hpp"
#include "tests/libs/fem/mesh/mesh_files.hpp"

namespace palpate::fem::test {

namespace {

enum class Storage { kAscii, kInline, kAppendedRaw, kAppendedBase64 };

struct Variant {
  const char* name;
  Storage storage = Storage::kAscii;
  bool compressed = false;
  bool big_endian = false;
  bool wide_header = false;
  bool single_precision = false;
  bool narrow_integers = false;  ///< UInt16 instead of Int64
  bool header_apart = false;     ///< base64 of an uncompressed header on its own
  int pieces = 1;
};

/// Writes one .vtu file in memory, as VTK does.
class VtuWriter {
 public:
  explicit VtuWriter(const Variant& variant) : variant_(variant) {}

  std::string Write(const TetMesh& mesh, const std::vector<int>& surface) {
    text_ = std::string("<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" ") +
            "version=\"1.0\" byte_order=\"" + (variant_.big_endian ? "Big" : "Little") +
            "Endian\" header_type=\"" + (variant_.wide_header ? "UInt64" : "UInt32") + "\"" +
            (variant_.compressed ? " compressor=\"vtkZLibDataCompressor\"" : "") + ">\n" +
            "  <UnstructuredGrid>\n";
    for (int piece = 0; piece < variant_.pieces; ++piece) Piece(mesh, surface);
    text_ += "  </UnstructuredGrid>\n";
    if (variant_.storage == Storage::kAppendedRaw || variant_.storage == Storage::kAppendedBase64) {
      text_ += std::string("  <AppendedData encoding=\"") +
               (variant_.storage == Storage::kAppendedRaw ? "raw" : "base64") + "\">\n   _" +
               appended_ + "\n  </AppendedData>\n";
    }
    return text_ + "</VTKFile>\n";
  }

 private:
  void Piece(const TetMesh& mesh, const std::vector<int>& surface) {
    const auto nodes_each = static_cast<int64_t>(mesh.cells.rows());
    std::vector<int64_t> nodes, offsets, types;
    const auto end_cell = [&](int64_t type) {
      offsets.push_back(static_cast<int64_t>(nodes.size()));
      types.push_back(type);
    };
    for (size_t k = 0; k < surface.size(); k += 3) {
      nodes.insert(nodes.end(), surface.begin() + static_cast<int64_t>(k),
                   surface.begin() + static_cast<int64_t>(k) + 3);
      end_cell(5);
    }
    for (int cell = 0; cell < mesh.CellCount(); ++cell) {
      for (const int node : mesh.cells.col(cell)) nodes.push_back(node);
      end_cell(nodes_each == 4 ? 10 : 24);
    }
    text_ += "    <Piece NumberOfPoints=\"" + std::to_string(mesh.NodeCount()) +
             "\" NumberOfCells=\"" + std::to_string(types.size()) + "\">\n      <Points>\n";
    Points(mesh);
    text_ += "      </Points>\n      <Cells>\n";
    Integers("connectivity", nodes);
    Integers("offsets", offsets);
    Integers("types", types);
    text_ += "      </Cells>\n    </Piece>\n";
  }

  void Points(const TetMesh& mesh) {
    std::string words, bytes;
    for (const double value : mesh.nodes_m.reshaped()) {
      words += FormatNumber(value) + " ";
      bytes += variant_.single_precision ? Binary(static_cast<float>(value), variant_.big_endian)
                                         : Binary(value, variant_.big_endian);
    }
    Array(variant_.single_precision ? "Float32" : "Float64",
          "Name=\"Points\" NumberOfComponents=\"3\"", words, bytes);
  }

  void Integers(const std::string& name, const std::vector<int64_t>& values) {
    std::string words, bytes;
    for (const int64_t value : values) {
      words += std::to_string(value) + "\n";
      bytes += variant_.narrow_integers ? Binary(static_cast<uint16_t>(value), variant_.big_endian)
                                        : Binary(value, variant_.big_endian);
    }
    Array(variant_.narrow_integers ? "UInt16" : "Int64", "Name=\"" + name + "\"", words, bytes);
  }

  void Array(const std::string& type, const std::string& attributes, const std::string& words,
             const std::string& bytes) {
    const std::string start = "        <DataArray type=\"" + type + "\" " + attributes + " format=";
    if (variant_.storage == Storage::kAscii) {
      text_ += start + "\"ascii\">\n" + words + "\n        </DataArray>\n";
    } else if (variant_.storage == Storage::kInline) {
      text_ +=
          start + "\"binary\">\n          " + Encoded(bytes, true) + "\n        </DataArray>\n";
    } else {
      text_ += start + "\"appended\" offset=\"" + std::to_string(appended_.size()) + "\"/>\n";
      appended_ += Encoded(bytes, variant_.storage == Storage::kAppendedBase64);
    }
  }

  std::string Header(std::initializer_list<size_t> values) const {
    std::string header;
    for (const size_t value : values) {
      header += variant_.wide_header ? Binary(static_cast<uint64_t>(value), variant_.big_endian)
                                     : Binary(static_cast<uint32_t>(value), variant_.big_endian);
    }
    return header;
  }

  std::string Encoded(const std::string& bytes, bool base64) const {
    std::string header = Header({bytes.size()});
    std::string data = bytes;
    if (variant_.compressed) {
      constexpr size_t kBlock = 100;  // so small that even small meshes have several blocks
      data.clear();
      header = Header({(bytes.size() + kBlock - 1) / kBlock, kBlock, bytes.size() % kBlock});
      for (size_t start = 0; start < bytes.size(); start += kBlock) {
        const std::string packed = mesh_io::Deflate(bytes.substr(start, kBlock));
        header += Header({packed.size()});
        data += packed;
      }
    }
    if (!base64) return header + data;
    if (variant_.compressed || variant_.header_apart) {
      return mesh_io::EncodeBase64(header) + mesh_io::EncodeBase64(data);
    }
    return mesh_io::EncodeBase64(header + data);
  }

  const Variant& variant_;
  std::string text_;
  std::string appended_;
};

constexpr Variant kVariants[] = {
    {.name = "ascii"},
    {.name = "ascii_two_pieces", .pieces = 2},
    {.name = "inline", .storage = Storage::kInline},
    {.name = "inline_header_apart", .storage = Storage::kInline, .header_apart = true},
    {.name = "inline_float32_uint16_wide",
     .storage = Storage::kInline,
     .wide_header = true,
     .single_precision = true,
     .narrow_integers = true},
    {.name = "inline_big_endian",
     .storage = Storage::kInline,
     .big_endian = true,
     .narrow_integers = true},
    {.name = "inline_zlib", .storage = Storage::kInline, .compressed = true},
    {.name = "inline_zlib_big_endian_wide",
     .storage = Storage::kInline,
     .compressed = true,
     .big_endian = true,
     .wide_header = true,
     .single_precision = true},
    {.name = "appended_raw", .storage = Storage::kAppendedRaw},
    {.name = "appended_raw_zlib", .storage = Storage::kAppendedRaw, .compressed = true},
    {.name = "appended_raw_big_endian_wide_two_pieces",
     .storage = Storage::kAppendedRaw,
     .big_endian = true,
     .wide_header = true,
     .pieces = 2},
    {.name = "appended_base64", .storage = Storage::kAppendedBase64},
    {.name = "appended_base64_zlib_wide",
     .storage = Storage::kAppendedBase64,
     .compressed = true,
     .wide_header = true},
};

}  // namespace

std::vector<MeshFile> AllVtuFiles(const TetMesh& mesh, const std::vector<int>& surface) {
  std::vector<MeshFile> files;
  for (const Variant& variant : kVariants) {
    files.push_back({std::string(variant.name) + ".vtu", VtuWriter(variant).Write(mesh, surface)});
  }
  return files;
}

std::string AsciiVtu(const TetMesh& mesh) { return VtuWriter(kVariants[0]).Write(mesh, {}); }

}  // namespace palpate::fem::test
