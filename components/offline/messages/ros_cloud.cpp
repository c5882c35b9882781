// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/messages/ros_cloud.hpp"

#include <bit>
#include <limits>
#include <map>

namespace palpate::offline {

namespace {

constexpr std::uint8_t kUint32 = 6;  // sensor_msgs/PointField
constexpr std::uint8_t kFloat32 = 7;
constexpr std::uint8_t kFloat64 = 8;

struct PlacedField {
  std::uint32_t offset = 0;
  std::uint32_t size = 0;
};

/// Where the numbers of a PointCloud2 stand.
struct Layout {
  std::map<std::string, PlacedField> fields;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t point_step = 0;
  std::uint32_t row_step = 0;
  bool big_endian = false;
  std::string_view data;

  std::uint64_t Bits(std::size_t point, const PlacedField& field) const {
    std::uint64_t bits = 0;
    for (std::uint32_t i = 0; i < field.size; ++i) {
      const std::uint32_t place = big_endian ? field.size - 1 - i : i;
      const auto byte = static_cast<std::uint8_t>(data[point + field.offset + place]);
      bits |= std::uint64_t{byte} << (8 * i);
    }
    return bits;
  }
  double Number(std::size_t point, const PlacedField& field) const {
    const std::uint64_t bits = Bits(point, field);
    if (field.size == sizeof(double)) return std::bit_cast<double>(bits);
    return double{std::bit_cast<float>(static_cast<std::uint32_t>(bits))};
  }
};

bool ReadLayout(recording::CdrReader reader, Layout* layout) {
  layout->height = reader.Length();
  layout->width = reader.Length();
  const std::uint32_t fields = reader.Length();
  for (std::uint32_t i = 0; i < fields && reader.ok(); ++i) {
    const std::string name(reader.String());
    const std::uint32_t offset = reader.Length();
    const auto datatype = static_cast<std::uint8_t>(reader.Bits(1));
    const std::uint32_t count = reader.Length();
    const bool color = name == "rgb" || name == "rgba";
    const bool number = datatype == kFloat32 || datatype == kFloat64 || datatype == kUint32;
    if (!number || count > 1 || (datatype == kUint32 && !color)) continue;
    layout->fields[name] = {offset, datatype == kFloat64 ? 8u : 4u};
  }
  layout->big_endian = reader.Bits(1) != 0;
  layout->point_step = reader.Length();
  layout->row_step = reader.Length();
  layout->data = reader.Array(reader.Length(), 1);
  if (!reader.ok() || layout->point_step == 0) return false;
  for (const auto& [name, field] : layout->fields) {
    if (std::uint64_t{field.offset} + field.size > layout->point_step) return false;
  }
  const std::uint64_t row = std::uint64_t{layout->width} * layout->point_step;
  // Some writers leave row_step at 0.
  if (layout->row_step < row) layout->row_step = static_cast<std::uint32_t>(row);
  if (layout->height == 0 || layout->width == 0) return true;
  return layout->row_step * std::uint64_t{layout->height - 1} + row <= layout->data.size();
}

}  // namespace

bool ReadCloud(std::string_view cdr, const MessageType& type, std::string* frame_id,
               experiment::PointCloud* cloud) {
  recording::CdrReader reader = type.At("header", cdr);
  reader.Bits(4);
  reader.Bits(4);
  *frame_id = reader.String();
  Layout layout;
  if (!ReadLayout(reader, &layout)) return false;
  for (const char* name : {"x", "y", "z"}) {
    if (!layout.fields.contains(name)) return false;
  }
  const PlacedField axes[3] = {layout.fields.at("x"), layout.fields.at("y"), layout.fields.at("z")};
  const auto rgb =
      layout.fields.contains("rgb") ? layout.fields.find("rgb") : layout.fields.find("rgba");
  *cloud = {};
  cloud->width = static_cast<int>(layout.width);
  cloud->height = static_cast<int>(layout.height);
  cloud->points_m.resize(3, Eigen::Index{layout.width} * Eigen::Index{layout.height});
  Eigen::Index index = 0;
  for (std::size_t v = 0; v < layout.height; ++v) {
    for (std::size_t u = 0; u < layout.width; ++u) {
      const std::size_t point = v * layout.row_step + u * layout.point_step;
      Eigen::Vector3d position_m;
      for (int axis = 0; axis < 3; ++axis) position_m[axis] = layout.Number(point, axes[axis]);
      if (!position_m.allFinite()) {
        position_m.setConstant(std::numeric_limits<double>::quiet_NaN());
      }
      cloud->points_m.col(index++) = position_m;
      if (rgb == layout.fields.end()) continue;
      const std::uint64_t bits = layout.Bits(point, rgb->second);
      for (const int shift : {16, 8, 0}) {
        cloud->colors_rgb.push_back(static_cast<std::uint8_t>(bits >> shift));
      }
    }
  }
  return true;
}

}  // namespace palpate::offline
