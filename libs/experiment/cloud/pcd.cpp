// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/cloud/pcd.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/cloud/cloud_builder.hpp"
#include "libs/experiment/cloud/lzf.hpp"
#include "libs/experiment/cloud/scalar.hpp"

namespace palpate::experiment {

namespace {

constexpr std::uint64_t kMostFields = 256;
constexpr std::uint64_t kLargestCount = 4096;

struct Field {
  std::string name;
  Scalar scalar;
  std::size_t count = 1;
  std::size_t offset = 0;  ///< in a point, bytes
  std::size_t column = 0;  ///< in an ascii line, words

  std::size_t bytes() const { return scalar.bytes * count; }
};

/// Red, green and blue as they are packed in one number of text. A float that holds them is tiny,
/// or negative, or no number: a whole number from 1 on is the packed integer itself, under whatever
/// type. What is no number keeps no colour; it is black.
std::uint64_t PackedColor(const Scalar& scalar, double value) {
  if (!std::isfinite(value)) return 0;
  const bool is_integer = value >= 1.0 && value <= 0xffffffff && value == std::floor(value);
  return is_integer ? static_cast<std::uint64_t>(value) : scalar.BitsOf(value);
}

enum class Data { kAscii, kBinary, kCompressed };

/// The header before the points.
struct Header {
  std::vector<Field> fields;
  std::uint64_t width = 0;
  std::uint64_t height = 1;
  std::uint64_t points = 0;
  std::size_t point_bytes = 0;
  std::size_t point_words = 0;
  Data data = Data::kAscii;

  const Field* Find(std::string_view name) const {
    const auto found = std::find_if(fields.begin(), fields.end(),
                                    [&](const Field& field) { return field.name == name; });
    return found == fields.end() ? nullptr : &*found;
  }
};

class PcdReader {
 public:
  explicit PcdReader(const std::filesystem::path& file)
      : file_(file.string()), bytes_(ReadFile(file)), rest_(bytes_) {}

  PointCloud Read() {
    ReadHeader();
    CloudBuilder builder(header_.width, header_.height, Color() || Channels());
    if (header_.data == Data::kAscii) {
      ReadAscii(&builder);
    } else if (header_.data == Data::kBinary) {
      ReadBinary(&builder);
    } else {
      ReadCompressed(&builder);
    }
    return builder.Take();
  }

 private:
  [[noreturn]] void Refuse(const std::string& message) const {
    throw InputError(SourceLocation{file_, line_}, message);
  }
  [[noreturn]] void RefuseWhole(const std::string& message) const {
    throw InputError(SourceLocation{file_}, message);
  }

  const Field* Color() const {
    const Field* color = header_.Find("rgb");
    if (color == nullptr) color = header_.Find("rgba");
    return color != nullptr && color->scalar.bytes == 4 ? color : nullptr;
  }

  /// Red, green and blue in fields of their own, whole numbers.
  std::optional<std::array<const Field*, 3>> Channels() const {
    const std::array channels = {header_.Find("r"), header_.Find("g"), header_.Find("b")};
    const bool whole = std::all_of(channels.begin(), channels.end(), [](const Field* field) {
      return field != nullptr && field->count == 1 && field->scalar.kind != Scalar::Kind::kFloat;
    });
    if (!whole) return std::nullopt;
    return channels;
  }

  /// `value` of a field, a number.
  template <typename Value>
  static std::uint64_t Joined(const std::array<const Field*, 3>& channels, const Value& value) {
    std::uint64_t color = 0;
    for (const Field* channel : channels) {
      color = color << 8 | static_cast<std::uint64_t>(std::clamp(value(*channel), 0.0, 255.0));
    }
    return color;
  }

  void ReadHeader() {
    bool data_seen = false;
    std::optional<std::uint64_t> points;
    while (!data_seen) {
      if (rest_.empty()) RefuseWhole("is no PCD file: no line 'DATA' follows");
      std::string_view line = TakeLine(&rest_);
      ++line_;
      const std::string_view key = TakeWord(&line);
      if (key.empty() || key.starts_with('#')) continue;
      if (key == "POINTS") {
        points = Number(line, kMostPoints);
      } else if (key == "DATA") {
        ReadDataKind(line);
        data_seen = true;
      } else {
        ReadHeaderLine(key, line);
      }
    }
    CheckHeader(points);
  }

  std::uint64_t Number(std::string_view line, std::uint64_t max) const {
    std::uint64_t count = 0;
    if (!ParseCount(TakeWord(&line), max, &count)) {
      Refuse("a whole number up to " + std::to_string(max) + " is expected");
    }
    return count;
  }

  void ReadHeaderLine(std::string_view key, std::string_view line) {
    if (key == "FIELDS" || key == "COLUMNS") {
      for (auto name = TakeWord(&line); !name.empty(); name = TakeWord(&line)) {
        header_.fields.push_back({.name = std::string(name), .scalar = {}});
      }
      if (header_.fields.size() > kMostFields) Refuse("more than 256 fields");
    } else if (key == "SIZE") {
      EachField(line, [&](std::string_view word, Field* field) {
        field->scalar.bytes = Number(word, 8);
      });
    } else if (key == "TYPE") {
      EachField(line, [&](std::string_view word, Field* field) { ReadType(word, field); });
    } else if (key == "COUNT") {
      EachField(line, [&](std::string_view word, Field* field) {
        field->count = Number(word, kLargestCount);
      });
    } else if (key == "WIDTH") {
      header_.width = Number(line, kMostPoints);
    } else if (key == "HEIGHT") {
      header_.height = Number(line, kMostPoints);
    } else if (key == "VIEWPOINT") {
      CheckViewpoint(line);
    } else if (key != "VERSION") {
      Refuse("'" + std::string(key.substr(0, 20)) + "' is no line of a PCD header");
    }
  }

  /// tx ty tz qw qx qy qz. The format calls it the viewpoint of acquisition and does not say
  /// whether the points are in its frame; programs read it either way. Two have one meaning:
  /// identity, and the half turn about x that PCL's grabbers write beside points of the optical
  /// frame.
  void CheckViewpoint(std::string_view line) const {
    std::array<double, 7> values{};
    for (double& value : values) {
      if (!ParseFinite(TakeWord(&line), &value)) {
        Refuse("VIEWPOINT is seven numbers: translation, and rotation as a quaternion w x y z");
      }
    }
    const auto [tx, ty, tz, qw, qx, qy, qz] = values;
    const bool at_origin = tx == 0.0 && ty == 0.0 && tz == 0.0;
    if (at_origin && qy == 0.0 && qz == 0.0 && (qw == 0.0 || qx == 0.0)) return;
    Refuse(
        "the VIEWPOINT is not the camera, and PCD does not say which frame the points are in: "
        "transform them into the camera's optical frame and write VIEWPOINT 0 0 0 1 0 0 0");
  }

  template <typename Use>
  void EachField(std::string_view line, const Use& use) {
    for (Field& field : header_.fields) {
      const std::string_view word = TakeWord(&line);
      if (word.empty()) Refuse("one value for each of the FIELDS is expected");
      use(word, &field);
    }
    if (!TakeWord(&line).empty()) Refuse("more values than FIELDS");
  }

  void ReadType(std::string_view word, Field* field) const {
    if (word == "F") {
      field->scalar.kind = Scalar::Kind::kFloat;
    } else if (word == "U") {
      field->scalar.kind = Scalar::Kind::kUnsigned;
    } else if (word == "I") {
      field->scalar.kind = Scalar::Kind::kSigned;
    } else {
      Refuse("a TYPE is F, U or I");
    }
  }

  void ReadDataKind(std::string_view line) {
    const std::string_view word = TakeWord(&line);
    if (word == "ascii") {
      header_.data = Data::kAscii;
    } else if (word == "binary") {
      header_.data = Data::kBinary;
    } else if (word == "binary_compressed") {
      header_.data = Data::kCompressed;
    } else {
      Refuse("DATA is ascii, binary or binary_compressed");
    }
  }

  void CheckHeader(std::optional<std::uint64_t> points) {
    for (Field& field : header_.fields) {
      if (!field.scalar.IsSound()) {
        RefuseWhole("field '" + field.name + "' has a SIZE that its TYPE cannot have");
      }
      field.offset = header_.point_bytes;
      field.column = header_.point_words;
      header_.point_bytes += field.bytes();
      header_.point_words += field.count;
    }
    for (const char* name : {"x", "y", "z"}) {
      const Field* field = header_.Find(name);
      if (field == nullptr || field->count != 1) {
        RefuseWhole(std::string("the FIELDS hold no single '") + name + "'");
      }
    }
    header_.points = header_.width * header_.height;
    if (header_.points > kMostPoints || (points && *points != header_.points)) {
      RefuseWhole("WIDTH x HEIGHT is " + std::to_string(header_.points) +
                  (points ? ", POINTS is " + std::to_string(*points) : " points"));
    }
  }

  void ReadAscii(CloudBuilder* builder) {
    CheckSize(header_.points * (2 * header_.point_words - 1), rest_.size());
    std::vector<double> values(header_.point_words);
    const auto channels = Channels();
    for (std::uint64_t i = 0; i < header_.points; ++i) {
      std::string_view line = TakeLine(&rest_);
      ++line_;
      ReadWords(line, &values);
      const auto value = [&](const char* name) { return values[header_.Find(name)->column]; };
      builder->Add({value("x"), value("y"), value("z")});
      if (const Field* color = Color()) {
        builder->AddColor(PackedColor(color->scalar, values[color->column]));
      } else if (channels) {
        builder->AddColor(
            Joined(*channels, [&](const Field& field) { return values[field.column]; }));
      }
    }
  }

  void ReadWords(std::string_view line, std::vector<double>* values) const {
    std::size_t word_number = 0;
    for (const Field& field : header_.fields) {
      for (std::size_t i = 0; i < field.count; ++i, ++word_number) {
        const std::string_view word = TakeWord(&line);
        if (!field.scalar.Parse(word, &(*values)[word_number])) {
          Refuse(word.empty() ? "the line has fewer values than FIELDS"
                              : "'" + std::string(word.substr(0, 20)) + "' is no number");
        }
      }
    }
    if (!TakeWord(&line).empty()) Refuse("the line has more values than FIELDS");
  }

  void ReadBinary(CloudBuilder* builder) const {
    CheckSize(header_.points * header_.point_bytes, rest_.size());
    AddPoints(builder, [&](const Field& field, std::uint64_t i) {
      return rest_.data() + i * header_.point_bytes + field.offset;
    });
  }

  void ReadCompressed(CloudBuilder* builder) const {
    constexpr Scalar kSize{.kind = Scalar::Kind::kUnsigned, .bytes = 4};
    if (rest_.size() < 8) RefuseWhole("is cut short before its compressed points");
    const std::uint64_t packed = kSize.LoadBits(rest_.data(), ByteOrder::kLittle);
    const std::uint64_t unpacked = kSize.LoadBits(rest_.data() + 4, ByteOrder::kLittle);
    if (unpacked != header_.points * header_.point_bytes) {
      RefuseWhole("the compressed points are " + std::to_string(unpacked) + " bytes, the header " +
                  "says " + std::to_string(header_.points * header_.point_bytes));
    }
    CheckSize(packed, rest_.size() - 8);
    std::string bytes;
    if (!UnpackLzf(rest_.substr(8, packed), unpacked, &bytes)) {
      RefuseWhole("the compressed points are damaged");
    }
    AddPoints(builder, [&](const Field& field, std::uint64_t i) {  // field by field
      return bytes.data() + field.offset * header_.points + i * field.bytes();
    });
  }

  template <typename Place>
  void AddPoints(CloudBuilder* builder, const Place& place) const {
    const std::array<const Field*, 3> axes = {header_.Find("x"), header_.Find("y"),
                                              header_.Find("z")};
    const Field* color = Color();
    const auto channels = Channels();
    for (std::uint64_t i = 0; i < header_.points; ++i) {
      Eigen::Vector3d point;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Field& field = *axes[axis];
        point[ToIndex(axis)] = field.scalar.Load(place(field, i), ByteOrder::kLittle);
      }
      builder->Add(point);
      if (color != nullptr) {
        builder->AddColor(color->scalar.LoadBits(place(*color, i), ByteOrder::kLittle));
      } else if (channels) {
        builder->AddColor(Joined(*channels, [&](const Field& field) {
          return field.scalar.Load(place(field, i), ByteOrder::kLittle);
        }));
      }
    }
  }

  void CheckSize(std::uint64_t needed, std::uint64_t there) const {
    if (there < needed) {
      RefuseWhole("is cut short: " + std::to_string(there) + " of at least " +
                  std::to_string(needed) + " bytes of points");
    }
  }

  std::string file_;
  std::string bytes_;
  std::string_view rest_;
  int line_ = 0;
  Header header_;
};

}  // namespace

PointCloud ReadPcd(const std::filesystem::path& file) { return PcdReader(file).Read(); }

void WritePcd(const PointCloud& cloud, const std::filesystem::path& file) {
  CheckShape(cloud);
  const bool colored = !cloud.colors_rgb.empty();
  const std::string count = std::to_string(cloud.points_m.cols());
  std::string bytes = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n";
  bytes += colored ? "FIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\n"
                   : "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
  bytes += "WIDTH " + std::to_string(cloud.width) + "\nHEIGHT " + std::to_string(cloud.height) +
           "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA binary\n";
  for (Eigen::Index i = 0; i < cloud.points_m.cols(); ++i) {
    for (const double value : cloud.points_m.col(i)) {
      AppendLittleEndian(static_cast<float>(value), &bytes);
    }
    if (!colored) continue;
    const std::uint8_t* rgb = cloud.colors_rgb.data() + 3 * i;
    AppendLittleEndian(static_cast<std::uint32_t>(rgb[0] << 16 | rgb[1] << 8 | rgb[2]), &bytes);
  }
  WriteFile(file, bytes);
}

}  // namespace palpate::experiment
