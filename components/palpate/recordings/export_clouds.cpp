// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <cstring>
#include <map>

#include "components/palpate/recordings/topic_export.hpp"
#include "libs/experiment/cloud/pcd.hpp"
#include "libs/experiment/cloud/ply.hpp"
#include "libs/recording/ros2msg/flatten.hpp"

namespace palpate::command {

namespace {

constexpr std::uint8_t kFloat32 = 7;  // sensor_msgs/PointField

/// Layout of a PointCloud2, with float x, y, z in the host's byte order.
struct Layout {
  std::map<std::string, std::uint32_t> offsets;  ///< of fields that are 4 bytes
  std::uint32_t point_step = 0;
  std::uint64_t count = 0;
  std::string_view data;

  bool HasPositions() const {
    return offsets.contains("x") && offsets.contains("y") && offsets.contains("z");
  }
  float At(std::uint64_t point, std::uint32_t offset) const {
    float value = 0.0f;
    std::memcpy(&value, data.data() + point * point_step + offset, sizeof(value));
    return value;
  }
};

bool ReadCloud(std::string_view cdr, const MessageType& type, Layout* layout) {
  recording::CdrReader reader = AtField(cdr, type.name, "height", type.definitions);
  const std::uint64_t height = reader.Length();
  layout->count = height * reader.Length();
  const std::uint32_t fields = reader.Length();
  for (std::uint32_t i = 0; i < fields && reader.ok(); ++i) {
    const std::string name(reader.String());
    const std::uint32_t offset = reader.Length();
    const auto datatype = static_cast<std::uint8_t>(reader.Bits(1));
    const std::uint32_t count = reader.Length();
    // rgb travels in the bits of a float, or as uint32.
    const bool fits = datatype == kFloat32 || name == "rgb" || name == "rgba";
    if (fits && count == 1) layout->offsets[name] = offset;
  }
  const bool big_endian = reader.Bits(1) != 0;
  layout->point_step = reader.Length();
  reader.Length();  // row_step
  layout->data = reader.Array(reader.Length(), 1);
  if (!reader.ok() || big_endian || layout->point_step == 0) return false;
  for (const auto& [name, offset] : layout->offsets) {
    if (offset + sizeof(float) > layout->point_step) return false;
  }
  return layout->count <= layout->data.size() / layout->point_step;
}

experiment::PointCloud CloudOf(const Layout& layout) {
  experiment::PointCloud cloud;
  cloud.width = static_cast<int>(layout.count);
  cloud.points_m.resize(3, static_cast<Eigen::Index>(layout.count));
  const auto rgb = layout.offsets.find("rgb");
  for (std::uint64_t i = 0; i < layout.count; ++i) {
    cloud.points_m.col(static_cast<Eigen::Index>(i)) =
        Eigen::Vector3f(layout.At(i, layout.offsets.at("x")), layout.At(i, layout.offsets.at("y")),
                        layout.At(i, layout.offsets.at("z")))
            .cast<double>();
    if (rgb == layout.offsets.end()) continue;
    std::uint32_t bits = 0;
    std::memcpy(&bits, layout.data.data() + i * layout.point_step + rgb->second, sizeof(bits));
    for (const int shift : {16, 8, 0}) {
      cloud.colors_rgb.push_back(static_cast<std::uint8_t>(bits >> shift));
    }
  }
  return cloud;
}

class CloudExport : public TopicExport {
 public:
  CloudExport(MessageType type, std::filesystem::path folder, CloudFormat format)
      : type_(std::move(type)), folder_(std::move(folder)), format_(format) {}

  std::string Take(const recording::Message& message) override {
    Layout layout;
    if (!ReadCloud(message.data, type_, &layout) || !layout.HasPositions()) {
      return "is no little-endian cloud of FLOAT32 x, y, z";
    }
    std::filesystem::create_directories(folder_);
    const std::string name = std::to_string(StampOf(message, type_));
    if (format_ == CloudFormat::kPly) {
      experiment::WritePly(CloudOf(layout), folder_ / (name + ".ply"));
    } else {
      experiment::WritePcd(CloudOf(layout), folder_ / (name + ".pcd"));
    }
    return {};
  }

 private:
  MessageType type_;
  std::filesystem::path folder_;
  CloudFormat format_;
};

}  // namespace

std::unique_ptr<TopicExport> MakeCloudExport(MessageType type, std::filesystem::path folder,
                                             CloudFormat format) {
  return std::make_unique<CloudExport>(std::move(type), std::move(folder), format);
}

}  // namespace palpate::command
