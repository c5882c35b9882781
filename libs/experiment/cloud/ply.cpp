// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/cloud/ply.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/cloud/cloud_builder.hpp"
#include "libs/experiment/cloud/ply_header.hpp"
#include "libs/experiment/cloud/scalar.hpp"

namespace palpate::experiment {

namespace {

/// Which numbers of a vertex are wanted: x, y, z, red, green, blue.
constexpr std::array<std::string_view, 6> kWanted = {"x", "y", "z", "red", "green", "blue"};
using Vertex = std::array<double, kWanted.size()>;

/// The place among kWanted of what some programs write as `diffuse_red` or `r`; its size: none.
std::size_t PlaceOf(std::string_view property) {
  constexpr std::string_view kDiffuse = "diffuse_";
  if (property.starts_with(kDiffuse)) property.remove_prefix(kDiffuse.size());
  const auto wanted = std::find_if(kWanted.begin(), kWanted.end(), [property](auto name) {
    return property == name || (name.size() > 1 && property == name.substr(0, 1));
  });
  return static_cast<std::size_t>(wanted - kWanted.begin());
}

/// Hands out one number after the other, from text or bytes.
class NumberSource {
 public:
  NumberSource(std::string file, const PlyHeader& header, std::string_view rest)
      : file_(std::move(file)), format_(header.format), line_number_(header.lines), rest_(rest) {}

  /// Text has one line for each item.
  void BeginItem() {
    if (format_ != PlyFormat::kAscii) return;
    if (rest_.empty()) RefuseShort();
    line_ = TakeLine(&rest_);
    ++line_number_;
  }

  double Next(const Scalar& scalar) {
    if (format_ == PlyFormat::kAscii) return NextWord(scalar);
    if (rest_.size() < scalar.bytes) RefuseShort();
    const double value = scalar.Load(
        rest_.data(), format_ == PlyFormat::kBig ? ByteOrder::kBig : ByteOrder::kLittle);
    rest_.remove_prefix(scalar.bytes);
    return value;
  }

  void SkipProperty(const PlyProperty& property) {
    if (!property.list) {
      Next(property.scalar);
      return;
    }
    const double count = Next(property.count);
    for (double i = 0.0; i < count; ++i) Next(property.scalar);
  }

  /// A line of text holds no more than its item. What is left would be read as something else where
  /// the properties do not describe the data.
  void EndItem() {
    if (format_ != PlyFormat::kAscii || TakeWord(&line_).empty()) return;
    throw InputError(SourceLocation{file_, line_number_},
                     "the line has more values than the header has properties");
  }

  /// After the last item. Throws InputError where data are left.
  void CheckEnd() const {
    constexpr std::size_t kLineEnd = 2;  // that editors leave behind bytes
    const bool blank = rest_.find_first_not_of(" \t\r\n") == std::string_view::npos;
    if (blank && (format_ == PlyFormat::kAscii || rest_.size() <= kLineEnd)) return;
    throw InputError(SourceLocation{file_},
                     std::to_string(rest_.size()) +
                         " bytes are left after the last element: the properties in the header "
                         "do not describe the data; export the file again, or as PCD");
  }

  /// Each number takes at least one byte: refuses counts that cannot be before memory is taken.
  void CheckHolds(std::uint64_t numbers) const {
    if (rest_.size() < numbers) RefuseShort();
  }

 private:
  [[noreturn]] void RefuseShort() const {
    throw InputError(SourceLocation{file_}, "is cut short: the header promises more");
  }

  double NextWord(const Scalar& scalar) {
    const std::string_view word = TakeWord(&line_);
    double value = 0.0;
    if (!scalar.Parse(word, &value)) {
      throw InputError(SourceLocation{file_, line_number_},
                       word.empty() ? "the line has too few values"
                                    : "'" + std::string(word.substr(0, 20)) + "' is no number");
    }
    return value;
  }

  std::string file_;
  PlyFormat format_;
  int line_number_;
  std::string_view rest_;
  std::string_view line_;
};

/// Index into a Vertex for each property of the element; nullopt: skipped.
std::vector<std::optional<std::size_t>> PlacesOf(const PlyElement& vertex) {
  std::vector<std::optional<std::size_t>> places;
  for (const PlyProperty& property : vertex.properties) {
    const std::size_t place = PlaceOf(property.name);
    const bool usable = place < kWanted.size() && !property.list;
    places.push_back(usable ? std::optional(place) : std::nullopt);
  }
  return places;
}

/// Colours as other programs store them: bytes, 16 bits, whole numbers from 0 to 255, or floating
/// point from 0 to 1. Floating point above 1 somewhere in the cloud counts to 255.
class ColorScale {
 public:
  explicit ColorScale(const PlyElement& vertex) {
    for (const PlyProperty& property : vertex.properties) {
      const std::size_t place = PlaceOf(property.name);
      if (place < 3 || place == kWanted.size()) continue;
      is_float_ = is_float_ || property.scalar.kind == Scalar::Kind::kFloat;
      is_wide_ = property.scalar.kind == Scalar::Kind::kUnsigned && property.scalar.bytes == 2;
    }
  }

  /// A colour that is no number (of a point that is not seen) is black.
  void Add(const Vertex& numbers) {
    for (std::size_t channel = 3; channel < numbers.size(); ++channel) {
      const double value = std::isfinite(numbers[channel]) ? numbers[channel] : 0.0;
      least_ = std::min(least_, value);
      greatest_ = std::max(greatest_, value);
      values_.push_back(static_cast<float>(value));
    }
  }

  std::vector<std::uint8_t> Bytes(const std::string& file) const {
    const double full = is_wide_ ? 65535.0 : is_float_ && greatest_ <= 1.0 ? 1.0 : 255.0;
    if (least_ < 0.0 || greatest_ > full) {
      throw InputError(SourceLocation{file}, "a colour is " +
                                                 FormatNumber(least_ < 0.0 ? least_ : greatest_) +
                                                 ": from 0 to 255 is expected, or from 0 to 1 as "
                                                 "floating point");
    }
    std::vector<std::uint8_t> bytes;
    bytes.reserve(values_.size());
    for (const float value : values_) {
      bytes.push_back(
          static_cast<std::uint8_t>(std::lround(static_cast<double>(value) / full * 255.0)));
    }
    return bytes;
  }

 private:
  bool is_float_ = false;
  bool is_wide_ = false;
  double least_ = 0.0;
  double greatest_ = 0.0;
  std::vector<float> values_;  ///< of all points; a float holds every 16-bit number
};

std::size_t CountOf(const std::vector<std::optional<std::size_t>>& places, std::size_t first) {
  std::size_t count = 0;
  for (std::size_t wanted = first; wanted < first + 3; ++wanted) {
    if (std::find(places.begin(), places.end(), std::optional(wanted)) != places.end()) ++count;
  }
  return count;
}

CloudBuilder MakeBuilder(const PlyHeader& header, const PlyElement& vertex) {
  const bool organised = header.rows > 1 && header.columns * header.rows == vertex.count;
  return organised ? CloudBuilder(header.columns, header.rows, false)
                   : CloudBuilder(vertex.count, 1, false);
}

PointCloud ReadVertices(const std::string& file, const PlyHeader& header, const PlyElement& vertex,
                        NumberSource* source) {
  const auto places = PlacesOf(vertex);
  if (CountOf(places, 0) != 3) {
    throw InputError(SourceLocation{file}, "the vertices have no properties x, y and z");
  }
  const bool colored = CountOf(places, 3) == 3;
  source->CheckHolds(vertex.count * vertex.properties.size());
  CloudBuilder builder = MakeBuilder(header, vertex);
  ColorScale colors(vertex);
  for (std::uint64_t i = 0; i < vertex.count; ++i) {
    Vertex numbers{};
    source->BeginItem();
    for (std::size_t p = 0; p < places.size(); ++p) {
      const PlyProperty& property = vertex.properties[p];
      if (places[p]) {
        numbers[*places[p]] = source->Next(property.scalar);
      } else {
        source->SkipProperty(property);
      }
    }
    source->EndItem();
    builder.Add({numbers[0], numbers[1], numbers[2]});
    if (colored) colors.Add(numbers);
  }
  PointCloud cloud = builder.Take();
  if (colored) cloud.colors_rgb = colors.Bytes(file);
  return cloud;
}

void SkipElement(const PlyElement& element, NumberSource* source) {
  for (std::uint64_t i = 0; i < element.count; ++i) {
    source->BeginItem();
    for (const PlyProperty& property : element.properties) source->SkipProperty(property);
    source->EndItem();
  }
}

}  // namespace

PointCloud ReadPly(const std::filesystem::path& path) {
  const std::string file = path.string();
  const std::string bytes = ReadFile(path);
  std::string_view rest = bytes;
  const PlyHeader header = TakePlyHeader(file, &rest);
  NumberSource source(file, header, rest);
  std::optional<PointCloud> cloud;
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex" && !cloud) {
      cloud = ReadVertices(file, header, element, &source);
    } else {
      SkipElement(element, &source);
    }
  }
  if (!cloud) throw InputError(SourceLocation{file}, "has no element 'vertex'");
  source.CheckEnd();
  return *std::move(cloud);
}

void WritePly(const PointCloud& cloud, const std::filesystem::path& file) {
  CheckShape(cloud);
  const bool colored = !cloud.colors_rgb.empty();
  std::string bytes = "ply\nformat binary_little_endian 1.0\n";
  if (cloud.organised()) {
    bytes += "obj_info num_cols " + std::to_string(cloud.width) + "\nobj_info num_rows " +
             std::to_string(cloud.height) + "\n";
  }
  bytes += "element vertex " + std::to_string(cloud.points_m.cols()) +
           "\nproperty float x\nproperty float y\nproperty float z\n";
  if (colored) bytes += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  bytes += "end_header\n";
  for (Eigen::Index i = 0; i < cloud.points_m.cols(); ++i) {
    for (const double value : cloud.points_m.col(i)) {
      AppendLittleEndian(static_cast<float>(value), &bytes);
    }
    if (!colored) continue;
    for (Eigen::Index c = 3 * i; c < 3 * i + 3; ++c) {
      bytes.push_back(static_cast<char>(cloud.colors_rgb[At(c)]));
    }
  }
  WriteFile(file, bytes);
}

}  // namespace palpate::experiment
