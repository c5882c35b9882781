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

/// What a VTK file has of a mesh.
struct Grid {
  std::span<const double> points_m;  ///< x y z interleaved
  std::vector<int> connectivity;     ///< point numbers, cell by cell
  std::vector<int64_t> offsets;      ///< in it, of the end of each cell
  std::vector<uint8_t> types;        ///< of the cells
};

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

  void Cells(const Grid& grid) {
    Line({"<Cells>"});
    Array<int>("Int32", "connectivity", 1, grid.connectivity);
    Array<int64_t>("Int64", "offsets", 1, grid.offsets);
    Array<uint8_t>("UInt8", "types", 1, grid.types);
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

void WriteGrid(const std::filesystem::path& file, const Grid& grid, const VtuFields& fields,
               VtuEncoding encoding) {
  const auto point_count = static_cast<int64_t>(grid.points_m.size()) / 3;
  const auto cell_count = static_cast<int64_t>(grid.types.size());
  VtuText vtu(encoding);
  const char* byte_order =
      std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
  vtu.Line({"<?xml version=\"1.0\"?>"});
  vtu.Line({"<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"", byte_order,
            "\" header_type=\"UInt64\"",
            encoding == VtuEncoding::kAscii ? "" : " compressor=\"vtkZLibDataCompressor\"", ">"});
  vtu.Line({"<UnstructuredGrid>"});
  vtu.Line({"<Piece NumberOfPoints=\"", std::to_string(point_count), "\" NumberOfCells=\"",
            std::to_string(cell_count), "\">"});
  vtu.Fields("PointData", fields.of_nodes, point_count);
  vtu.Fields("CellData", fields.of_cells, cell_count);
  vtu.Line({"<Points>"});
  vtu.Array("Float64", "Points", 3, grid.points_m);
  vtu.Line({"</Points>"});
  vtu.Cells(grid);
  vtu.Line({"</Piece>"});
  vtu.Line({"</UnstructuredGrid>"});
  vtu.Line({"</VTKFile>"});
  WriteChecked(file, vtu.text());
}

}  // namespace

void WriteVtu(const std::filesystem::path& file, const TetMesh& mesh,
              const Eigen::Ref<const Eigen::VectorXd>& x_m, const VtuFields& fields,
              VtuEncoding encoding) {
  constexpr uint8_t kTet4 = 10;
  constexpr uint8_t kTet10 = 24;
  PALPATE_CHECK(x_m.size() == 3 * mesh.nodes_m.cols(), x_m.size(), mesh.nodes_m.cols());
  const auto nodes_each = mesh.cells.rows();
  Grid grid{.points_m = std::span(x_m.data(), static_cast<size_t>(x_m.size())),
            .connectivity = {mesh.cells.data(), mesh.cells.data() + mesh.cells.size()},
            .offsets = {},
            .types = {}};
  for (int cell = 1; cell <= mesh.CellCount(); ++cell) grid.offsets.push_back(cell * nodes_each);
  grid.types.assign(grid.offsets.size(), nodes_each == 4 ? kTet4 : kTet10);
  WriteGrid(file, grid, fields, encoding);
}

void WriteVtuLines(const std::filesystem::path& file, const std::vector<Eigen::Matrix3Xd>& lines_m,
                   const VtuFields& fields, VtuEncoding encoding) {
  constexpr uint8_t kPolyLine = 4;
  std::vector<double> points_m;
  Grid grid;
  for (const Eigen::Matrix3Xd& line_m : lines_m) {
    PALPATE_CHECK(line_m.cols() >= 2, line_m.cols());
    points_m.insert(points_m.end(), line_m.data(), line_m.data() + line_m.size());
    for (Eigen::Index p = 0; p < line_m.cols(); ++p) {
      grid.connectivity.push_back(static_cast<int>(grid.connectivity.size()));
    }
    grid.offsets.push_back(static_cast<int64_t>(grid.connectivity.size()));
    grid.types.push_back(kPolyLine);
  }
  grid.points_m = points_m;
  WriteGrid(file, grid, fields, encoding);
}

}  // namespace palpate::fem
