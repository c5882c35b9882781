// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "libs/core/text.hpp"
#include "libs/fem/mesh_io/formats.hpp"
#include "libs/fem/mesh_io/limits.hpp"
#include "libs/fem/mesh_io/scanner.hpp"

namespace palpate::fem::mesh_io {

namespace {

std::string UpperCase(std::string_view word) {
  std::string upper(word);
  std::transform(upper.begin(), upper.end(), upper.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::toupper(letter)); });
  return upper;
}

std::optional<ScalarType> FindType(std::string_view name) {
  static constexpr auto kTypes = std::to_array<std::pair<std::string_view, ScalarType>>({
      {"char", ScalarType::kInt8},
      {"unsigned_char", ScalarType::kUInt8},
      {"short", ScalarType::kInt16},
      {"unsigned_short", ScalarType::kUInt16},
      {"int", ScalarType::kInt32},
      {"unsigned_int", ScalarType::kUInt32},
      {"signed_char", ScalarType::kInt8},
      {"vtktypeint8", ScalarType::kInt8},
      {"vtktypeuint8", ScalarType::kUInt8},
      {"vtktypeint16", ScalarType::kInt16},
      {"vtktypeuint16", ScalarType::kUInt16},
      {"vtktypeuint32", ScalarType::kUInt32},
      {"long_long", ScalarType::kInt64},
      {"unsigned_long_long", ScalarType::kUInt64},
      {"vtkIdType", ScalarType::kInt32},
      {"vtktypeint32", ScalarType::kInt32},
      {"long", ScalarType::kInt64},
      {"unsigned_long", ScalarType::kUInt64},
      {"vtktypeint64", ScalarType::kInt64},
      {"vtktypeuint64", ScalarType::kUInt64},
      {"float", ScalarType::kFloat32},
      {"double", ScalarType::kFloat64},
  });
  for (const auto& [known, type] : kTypes) {
    if (known == name) return type;
  }
  return std::nullopt;
}

ScalarType ReadType(Scanner* scanner) {
  const std::string_view name = scanner->Token("a data type");
  if (const auto type = FindType(name)) return *type;
  scanner->Fail("data type '" + Excerpt(name) + "' is not read");
}

/// VTK writes blanks and other letters of names as %20.
std::string Decoded(std::string_view name) {
  std::string decoded;
  for (size_t k = 0; k < name.size(); ++k) {
    unsigned code = 0;
    const std::string_view hex = name.substr(k + 1, 2);
    const auto [end, error] = std::from_chars(hex.data(), hex.data() + hex.size(), code, 16);
    const bool coded =
        name[k] == '%' && hex.size() == 2 && error == std::errc() && end == hex.data() + 2;
    decoded.push_back(coded ? static_cast<char>(code) : name[k]);
    if (coded) k += 2;
  }
  return decoded;
}

/// One entry of a binary string array: its length, whose two highest bits say in how many bytes
/// it stands, then the text.
void SkipBinaryString(Scanner* scanner) {
  constexpr const char* kWhat = "the length of a string";
  const auto byte = [&] { return static_cast<unsigned char>(scanner->Bytes(1, kWhat).front()); };
  const unsigned first = byte();
  const unsigned more = (first >> 6) == 3 ? 0 : (first >> 6) == 2 ? 1 : (first >> 6) == 1 ? 3 : 7;
  uint64_t length = first & 0x3f;
  for (unsigned k = 0; k < more; ++k) length = length << 8 | byte();
  scanner->Bytes(length, "a string");
}

/// Cells as VTK 5 stores them: cell k has nodes offsets[k] to offsets[k + 1] - 1 of `nodes`.
struct CellArray {
  std::vector<int64_t> offsets = {0};
  std::vector<int64_t> nodes;
};

/// Reads the sections of one file (VTK File Formats, "Simple Legacy Formats").
class LegacyReader {
 public:
  LegacyReader(std::string_view bytes, MeshBuilder* builder)
      : scanner_(builder->file(), bytes), builder_(builder) {}

  void Read() {
    ReadHeader();
    while (!points_read_ || !cells_ || !types_) ReadSection();
    AddCells();
    ReadAttributes();
  }

 private:
  void ReadHeader();
  void ReadSection();
  void ReadPoints();
  void ReadPackedCells();
  void ReadOffsetCells();
  void ReadCellTypes();
  void SkipMetadata();
  void SkipField();
  void SkipFieldValues(std::string_view type_name, int64_t count);
  void AddCells();
  void ReadAttributes();
  void BeginAttributes(bool of_cells);
  void ReadScalars();
  void ReadAttributeField();
  bool SkipAttribute(const std::string& keyword);
  void TakeCellArray(const std::string& name, ScalarType type, int64_t components);

  int64_t ReadCount(const char* what) { return scanner_.TextInteger(0, kMaxCount, what); }

  /// The end of a line of text; binary numbers begin right behind it.
  void EndLine() {
    if (scanner_.binary()) scanner_.Line("binary data");
  }

  void CheckRoom(int64_t count, ScalarType type, const char* what) {
    scanner_.CheckRoom(count, scanner_.binary() ? SizeInBytes(type) : 2, what);
  }

  std::vector<int64_t> ReadIntegers(ScalarType type, int64_t count, const char* what) {
    if (!IsInteger(type)) scanner_.Fail(std::string(what) + " must be integers");
    CheckRoom(count, type, what);
    std::vector<int64_t> values(static_cast<size_t>(count));
    for (int64_t& value : values) value = scanner_.Integer(type, 0, kMaxCount, what);
    return values;
  }

  Scanner scanner_;
  MeshBuilder* builder_;
  bool offsets_apart_ = false;  ///< version 5: OFFSETS and CONNECTIVITY
  bool points_read_ = false;
  std::optional<CellArray> cells_;
  std::optional<std::vector<int64_t>> types_;
  bool of_cells_ = false;        ///< the attributes at hand, else of points
  int64_t attribute_count_ = 0;  ///< cells or points that have them
};

void LegacyReader::ReadHeader() {
  constexpr std::string_view kMagic = "# vtk DataFile Version ";
  const std::string_view first = scanner_.Line("the header");
  if (!first.starts_with(kMagic) || first.size() == kMagic.size()) {
    scanner_.Fail("is no VTK legacy file: its first line must be '# vtk DataFile Version x.y'");
  }
  const char major = first[kMagic.size()];
  if (major < '1' || major > '5') scanner_.Fail("file version is not read (only 1 to 5)");
  offsets_apart_ = major == '5';
  scanner_.Line("the title");
  const std::string encoding = UpperCase(scanner_.Token("ASCII or BINARY"));
  if (encoding != "ASCII" && encoding != "BINARY") scanner_.Fail("must be ASCII or BINARY");
  if (UpperCase(scanner_.Token("DATASET")) != "DATASET") scanner_.Fail("must be DATASET");
  if (UpperCase(scanner_.Token("the kind of data set")) != "UNSTRUCTURED_GRID") {
    scanner_.Fail("only UNSTRUCTURED_GRID is read");
  }
  if (encoding == "BINARY") scanner_.SetBinary(std::endian::native != std::endian::big);
}

void LegacyReader::ReadSection() {
  const std::string keyword = UpperCase(scanner_.TokenOrEnd());
  if (keyword == "POINTS" && !points_read_) {
    ReadPoints();
  } else if (keyword == "CELLS" && !cells_) {
    offsets_apart_ ? ReadOffsetCells() : ReadPackedCells();
  } else if (keyword == "CELL_TYPES" && !types_) {
    ReadCellTypes();
  } else if (keyword == "METADATA") {
    SkipMetadata();
  } else if (keyword == "FIELD") {
    SkipField();
  } else {
    scanner_.Fail(std::string("expected ") +
                  (!points_read_ ? "POINTS"
                   : !cells_     ? "CELLS"
                                 : "CELL_TYPES") +
                  (keyword.empty() ? ", the file ends" : ""));
  }
}

void LegacyReader::ReadPoints() {
  const int64_t count = ReadCount("the number of points");
  const ScalarType type = ReadType(&scanner_);
  EndLine();
  CheckRoom(3 * count, type, "coordinates");
  for (int64_t k = 0; k < count; ++k) {
    const double x = scanner_.Real(type, "a coordinate");
    const double y = scanner_.Real(type, "a coordinate");
    const double z = scanner_.Real(type, "a coordinate");
    builder_->AddNode(x, y, z);
  }
  points_read_ = true;
}

void LegacyReader::ReadPackedCells() {
  const int64_t count = ReadCount("the number of cells");
  const int64_t size = ReadCount("the size of the cell list");
  EndLine();
  CheckRoom(size, ScalarType::kInt32, "cell entries");
  if (count > size) scanner_.Fail("the cell list is shorter than the number of cells");
  cells_.emplace();
  int64_t left = size;
  for (int64_t cell = 0; cell < count; ++cell) {
    const int64_t nodes =
        scanner_.Integer(ScalarType::kInt32, 0, left - 1, "the number of nodes of a cell");
    for (int64_t k = 0; k < nodes; ++k) {
      cells_->nodes.push_back(scanner_.Integer(ScalarType::kInt32, 0, kMaxCount, "a node index"));
    }
    cells_->offsets.push_back(static_cast<int64_t>(cells_->nodes.size()));
    left -= nodes + 1;
  }
  if (left != 0) scanner_.Fail("the cell list has another size than CELLS says");
}

void LegacyReader::ReadOffsetCells() {
  const int64_t offset_count = ReadCount("the number of cell offsets");
  const int64_t node_count = ReadCount("the size of the connectivity");
  if (scanner_.Token("OFFSETS") != "OFFSETS") scanner_.Fail("expected OFFSETS");
  const ScalarType offset_type = ReadType(&scanner_);
  EndLine();
  cells_.emplace();
  cells_->offsets = ReadIntegers(offset_type, offset_count, "a cell offset");
  const auto& offsets = cells_->offsets;
  if (offsets.empty() || offsets.front() != 0 || offsets.back() != node_count ||
      !std::is_sorted(offsets.begin(), offsets.end())) {
    scanner_.Fail("cell offsets must rise from 0 to " + std::to_string(node_count));
  }
  if (scanner_.Token("CONNECTIVITY") != "CONNECTIVITY") scanner_.Fail("expected CONNECTIVITY");
  const ScalarType node_type = ReadType(&scanner_);
  EndLine();
  cells_->nodes = ReadIntegers(node_type, node_count, "a node index");
}

void LegacyReader::ReadCellTypes() {
  const int64_t count = ReadCount("the number of cell types");
  EndLine();
  types_ = ReadIntegers(ScalarType::kInt32, count, "a cell type");
  // A type cut off behind its first digit would still be a number: 1 or 2 of 10 or 24.
  if (!scanner_.binary() && scanner_.LastTokenTouchesEnd() && count > 0 && types_->back() < 10) {
    scanner_.Fail("the file ends within the cell types");
  }
}

/// Runs to the next blank line.
void LegacyReader::SkipMetadata() {
  scanner_.Line("METADATA");
  while (scanner_.Line("the end of METADATA").find_first_not_of(" \t") != std::string_view::npos) {
  }
}

void LegacyReader::SkipField() {
  scanner_.Token("the name of the field");
  const int64_t arrays = ReadCount("the number of arrays");
  for (int64_t array = 0; array < arrays; ++array) {
    if (scanner_.Token("the name of an array") == "METADATA") {
      SkipMetadata();
      scanner_.Token("the name of an array");
    }
    const int64_t components = ReadCount("the number of components");
    const int64_t tuples = ReadCount("the number of tuples");
    const std::string type(scanner_.Token("a data type"));
    if (components > 0 && tuples > kMaxCount / components) scanner_.Fail("the array is too long");
    SkipFieldValues(type, components * tuples);
  }
}

/// Numbers, bits (eight in a byte) or strings (one a line in text).
void LegacyReader::SkipFieldValues(std::string_view type_name, int64_t count) {
  const std::string type = UpperCase(type_name);
  const bool strings = type == "STRING" || type == "UTF8_STRING";
  if (strings && !scanner_.binary()) {
    scanner_.Line("a string array");
    scanner_.CheckRoom(count, 1, "strings");
    for (int64_t k = 0; k < count; ++k) scanner_.Line("a string");
    return;
  }
  EndLine();
  if (strings) {
    scanner_.CheckRoom(count, 1, "strings");
    for (int64_t k = 0; k < count; ++k) SkipBinaryString(&scanner_);
    return;
  }
  if (type == "BIT" && scanner_.binary()) {
    scanner_.Bytes(static_cast<size_t>(count + 7) / 8, "bits");
    return;
  }
  const std::optional<ScalarType> number = type == "BIT" ? ScalarType::kInt8 : FindType(type_name);
  if (!number) scanner_.Fail("data type '" + Excerpt(type_name) + "' is not read");
  CheckRoom(count, *number, "field values");
  for (int64_t k = 0; k < count; ++k) {
    scanner_.binary() ? scanner_.Bytes(SizeInBytes(*number), "a field value")
                      : scanner_.Token("a field value");
  }
}

void LegacyReader::AddCells() {
  const auto& offsets = cells_->offsets;
  if (types_->size() + 1 != offsets.size()) {
    scanner_.Fail("there are " + std::to_string(types_->size()) + " cell types for " +
                  std::to_string(offsets.size() - 1) + " cells");
  }
  for (size_t cell = 0; cell < types_->size(); ++cell) {
    const auto start = static_cast<size_t>(offsets[cell]);
    const auto end = static_cast<size_t>(offsets[cell + 1]);
    builder_->AddVtkCell((*types_)[cell], std::span(cells_->nodes).subspan(start, end - start));
  }
}

/// What follows the cells is read as far as it is understood: it only names groups.
void LegacyReader::ReadAttributes() {
  while (true) {
    const std::string keyword = UpperCase(scanner_.TokenOrEnd());
    if (keyword == "METADATA") {
      SkipMetadata();
    } else if (keyword == "CELL_DATA" || keyword == "POINT_DATA") {
      BeginAttributes(keyword == "CELL_DATA");
    } else if (keyword == "SCALARS") {
      ReadScalars();
    } else if (keyword == "FIELD") {
      ReadAttributeField();
    } else if (!SkipAttribute(keyword)) {
      return;
    }
  }
}

void LegacyReader::BeginAttributes(bool of_cells) {
  of_cells_ = of_cells;
  attribute_count_ = ReadCount("the number of cells or points");
  if (of_cells && attribute_count_ != builder_->VtkCellCount()) {
    scanner_.Fail("CELL_DATA has another number of cells than CELLS");
  }
  if (!of_cells && attribute_count_ != builder_->NodeCount()) {
    scanner_.Fail("POINT_DATA has another number of points than POINTS");
  }
}

/// SCALARS name type [components], then LOOKUP_TABLE name.
void LegacyReader::ReadScalars() {
  const std::string name(scanner_.Token("the name of an array"));
  const std::string type_name(scanner_.Token("a data type"));
  std::string next(scanner_.Token("LOOKUP_TABLE"));
  int64_t components = 1;
  if (UpperCase(next) != "LOOKUP_TABLE") {
    components = std::strtol(next.c_str(), nullptr, 10);
    next = scanner_.Token("LOOKUP_TABLE");
  }
  if (UpperCase(next) != "LOOKUP_TABLE" || components < 1 || components > 4) {
    scanner_.Fail("expected LOOKUP_TABLE");
  }
  scanner_.Token("the name of a table");
  const std::optional<ScalarType> type = FindType(type_name);
  if (!of_cells_ || !type) {
    SkipFieldValues(type_name, components * attribute_count_);
    return;
  }
  EndLine();
  TakeCellArray(name, *type, components);
}

/// Attributes other than scalars and fields name no group; false: `keyword` is none.
bool LegacyReader::SkipAttribute(const std::string& keyword) {
  static constexpr auto kComponents =
      std::to_array<std::pair<std::string_view, int64_t>>({{"VECTORS", 3},
                                                           {"NORMALS", 3},
                                                           {"TENSORS", 9},
                                                           {"TENSORS6", 6},
                                                           {"GLOBAL_IDS", 1},
                                                           {"PEDIGREE_IDS", 1}});
  constexpr int64_t kMostComponents = 1000;
  if (keyword == "COLOR_SCALARS" || keyword == "LOOKUP_TABLE") {
    scanner_.Token("the name of an array");
    const int64_t size = ReadCount("a size");
    const bool table = keyword == "LOOKUP_TABLE";  // four bytes for each of its colours
    if (!table && size > kMostComponents) scanner_.Fail("too many components");
    SkipFieldValues("unsigned_char", table ? 4 * size : size * attribute_count_);
    return true;
  }
  if (keyword == "TEXTURE_COORDINATES") {
    scanner_.Token("the name of an array");
    const int64_t size = scanner_.TextInteger(1, 3, "a dimension");
    SkipFieldValues(std::string(scanner_.Token("a data type")), size * attribute_count_);
    return true;
  }
  for (const auto& [name, components] : kComponents) {
    if (name != keyword) continue;
    scanner_.Token("the name of an array");
    SkipFieldValues(std::string(scanner_.Token("a data type")), components * attribute_count_);
    return true;
  }
  return false;
}

void LegacyReader::ReadAttributeField() {
  scanner_.Token("the name of the field");
  const int64_t arrays = ReadCount("the number of arrays");
  for (int64_t array = 0; array < arrays; ++array) {
    std::string name(scanner_.Token("the name of an array"));
    if (name == "METADATA") {
      SkipMetadata();
      name = scanner_.Token("the name of an array");
    }
    const int64_t components = ReadCount("the number of components");
    const int64_t tuples = ReadCount("the number of tuples");
    const std::string type_name(scanner_.Token("a data type"));
    if (components > 0 && tuples > kMaxCount / components) scanner_.Fail("the array is too long");
    const std::optional<ScalarType> type = FindType(type_name);
    if (!of_cells_ || !type || tuples != builder_->VtkCellCount()) {
      SkipFieldValues(type_name, components * tuples);
      continue;
    }
    EndLine();
    TakeCellArray(name, *type, components);
  }
}

void LegacyReader::TakeCellArray(const std::string& name, ScalarType type, int64_t components) {
  const int64_t count = components * builder_->VtkCellCount();
  CheckRoom(count, type, "cell data");
  std::vector<double> values;
  values.reserve(static_cast<size_t>(count));
  for (int64_t k = 0; k < count; ++k) values.push_back(scanner_.RealOrNan(type, "cell data"));
  if (components == 1) builder_->AddVtkCellData(Decoded(name), 0, values);
}

}  // namespace

void ReadLegacyVtk(std::string_view bytes, MeshBuilder* builder) {
  LegacyReader(bytes, builder).Read();
}

}  // namespace palpate::fem::mesh_io
