// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/mesh_io/write_vtu.hpp"

#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <initializer_list>
#include <span>
#include <string_view>
#include <system_error>
#include <type_traits>

#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/fem/mesh_io/base64.hpp"
#include "libs/fem/mesh_io/zlib_stream.hpp"

namespace palpate::fem {

namespace {

template <typename Value>
std::string_view BytesOf(std::span<const Value> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

/// Header and blocks as VTK's readers expect them, each in base64 of its own.
std::string CompressedText(std::string_view bytes) {
  constexpr size_t kBlockSize = size_t{1} << 20;
  const size_t block_count = (bytes.size() + kBlockSize - 1) / kBlockSize;
  std::vector<uint64_t> header = {block_count, kBlockSize, bytes.size() % kBlockSize};
  std::string packed;
  for (size_t block = 0; block < block_count; ++block) {
    const std::string piece = mesh_io::Deflate(bytes.substr(block * kBlockSize, kBlockSize));
    header.push_back(piece.size());
    packed += piece;
  }
  return mesh_io::EncodeBase64(BytesOf(std::span<const uint64_t>(header))) +
         mesh_io::EncodeBase64(packed);
}

template <typename Value>
std::string AsciiText(std::span<const Value> values) {
  std::string text;
  for (const Value value : values) {
    if constexpr (std::is_floating_point_v<Value>) {
      text += FormatNumber(value);
    } else {
      text += std::to_string(value);
    }
    text += ' ';
  }
  return text;
}

std::string EscapedName(std::string_view name) {
  std::string escaped;
  for (const char letter : name) {
    switch (letter) {
      case '&': escaped += "&amp;"; break;
      case '<': escaped += "&lt;"; break;
      case '>': escaped += "&gt;"; break;
      case '"': escaped += "&quot;"; break;
      default: escaped += letter;
    }
  }
  return escaped;
}

/// Builds the text of the file.
class VtuText {
 public:
  explicit VtuText(VtuEncoding encoding) : encoding_(encoding) {}

  void Line(std::initializer_list<std::string_view> words) {
    for (const std::string_view word : words) text_ += word;
    text_ += '\n';
  }

  template <typename Value>
  void Array(const char* type, std::string_view name, int64_t components,
             std::span<const Value> values) {
    const bool ascii = encoding_ == VtuEncoding::kAscii;
    Line({"<DataArray type=\"", type, "\" Name=\"", EscapedName(name), "\" NumberOfComponents=\"",
          std::to_string(components), "\" format=\"", ascii ? "ascii" : "binary", "\">"});
    Line({ascii ? AsciiText(values) : CompressedText(BytesOf(values))});
    Line({"</DataArray>"});
  }

  void Fields(const char* element, const std::vector<VtuField>& fields, int64_t count) {
    Line({"<", element, ">"});
    for (const VtuField& field : fields) {
      const auto components = field.values.rows();
      PALPATE_CHECK((components == 1 || components == 3) && field.values.cols() == count,
                    field.name, components, field.values.cols(), count);
      Array("Float64", field.name, components,
            std::span(field.values.data(), static_cast<size_t>(field.values.size())));
    }
    Line({"</", element, ">"});
  }

  void Cells(const TetMesh& mesh) {
    const auto nodes_each = mesh.cells.rows();
    std::vector<int64_t> offsets;
    for (int cell = 1; cell <= mesh.CellCount(); ++cell) offsets.push_back(cell * nodes_each);
    const std::vector<uint8_t> types(offsets.size(), nodes_each == 4 ? 10 : 24);
    Line({"<Cells>"});
    Array<int>("Int32", "connectivity", 1,
               std::span(mesh.cells.data(), static_cast<size_t>(mesh.cells.size())));
    Array<int64_t>("Int64", "offsets", 1, offsets);
    Array<uint8_t>("UInt8", "types", 1, types);
    Line({"</Cells>"});
  }

  const std::string& text() const { return text_; }

 private:
  VtuEncoding encoding_;
  std::string text_;
};

void WriteChecked(const std::filesystem::path& file, std::string_view text) {
  const auto fail = [&file](int error) {
    throw RunError(file.string() + ": cannot be written: " + std::strerror(error));
  };
  std::FILE* stream = std::fopen(file.c_str(), "wb");
  if (stream == nullptr) fail(errno);
  int error = 0;
  if (std::fwrite(text.data(), 1, text.size(), stream) != text.size()) error = errno;
  if (std::fclose(stream) != 0 && error == 0) error = errno;
  if (error == 0) return;
  std::error_code ignored;
  if (std::filesystem::is_regular_file(file, ignored)) std::filesystem::remove(file, ignored);
  fail(error);
}

}  // namespace

void WriteVtu(const std::filesystem::path& file, const TetMesh& mesh,
              const Eigen::Ref<const Eigen::VectorXd>& x_m, const VtuFields& fields,
              VtuEncoding encoding) {
  PALPATE_CHECK(x_m.size() == 3 * mesh.nodes_m.cols(), x_m.size(), mesh.nodes_m.cols());
  VtuText vtu(encoding);
  const char* byte_order =
      std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
  vtu.Line({"<?xml version=\"1.0\"?>"});
  vtu.Line({"<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"", byte_order,
            "\" header_type=\"UInt64\"",
            encoding == VtuEncoding::kAscii ? "" : " compressor=\"vtkZLibDataCompressor\"", ">"});
  vtu.Line({"<UnstructuredGrid>"});
  vtu.Line({"<Piece NumberOfPoints=\"", std::to_string(mesh.NodeCount()), "\" NumberOfCells=\"",
            std::to_string(mesh.CellCount()), "\">"});
  vtu.Fields("PointData", fields.of_nodes, mesh.NodeCount());
  vtu.Fields("CellData", fields.of_cells, mesh.CellCount());
  vtu.Line({"<Points>"});
  vtu.Array("Float64", "Points", 3, std::span(x_m.data(), static_cast<size_t>(x_m.size())));
  vtu.Line({"</Points>"});
  vtu.Cells(mesh);
  vtu.Line({"</Piece>"});
  vtu.Line({"</UnstructuredGrid>"});
  vtu.Line({"</VTKFile>"});
  WriteChecked(file, vtu.text());
}

}  // namespace palpate::fem
