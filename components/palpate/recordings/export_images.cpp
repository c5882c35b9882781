// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <string_view>

#include "components/palpate/recordings/topic_export.hpp"
#include "libs/recording/ros2msg/flatten.hpp"
#include "libs/rgbd/png.hpp"

namespace palpate::command {

namespace {

struct RosImage {
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::uint32_t step = 0;
  bool big_endian = false;
  std::string encoding;
  std::string_view data;

  std::string_view Row(std::uint32_t v) const { return data.substr(std::size_t{v} * step, step); }
};

bool ReadImage(std::string_view cdr, const MessageType& type, RosImage* image) {
  recording::CdrReader reader = AtField(cdr, type.name, "height", type.definitions);
  image->height = reader.Length();
  image->width = reader.Length();
  image->encoding = reader.String();
  image->big_endian = reader.Bits(1) != 0;
  image->step = reader.Length();
  image->data = reader.Array(reader.Length(), 1);
  return reader.ok() && image->data.size() >= std::uint64_t{image->step} * image->height;
}

rgbd::DepthImage DepthOf(const RosImage& image) {
  rgbd::DepthImage depth(static_cast<int>(image.width), static_cast<int>(image.height));
  for (std::uint32_t v = 0; v < image.height; ++v) {
    const std::string_view row = image.Row(v);
    for (std::uint32_t u = 0; u < image.width; ++u) {
      const auto low = static_cast<std::uint8_t>(row[2 * u + (image.big_endian ? 1 : 0)]);
      const auto high = static_cast<std::uint8_t>(row[2 * u + (image.big_endian ? 0 : 1)]);
      *depth.Pixel(static_cast<int>(u), static_cast<int>(v)) =
          static_cast<std::uint16_t>(low | high << 8);
    }
  }
  return depth;
}

/// `channels`: of the message, 1 or 3; `reversed`: blue first.
rgbd::ColorImage ColorOf(const RosImage& image, std::uint32_t channels, bool reversed) {
  rgbd::ColorImage color(static_cast<int>(image.width), static_cast<int>(image.height));
  for (std::uint32_t v = 0; v < image.height; ++v) {
    const std::string_view row = image.Row(v);
    for (std::uint32_t u = 0; u < image.width; ++u) {
      std::uint8_t* pixel = color.Pixel(static_cast<int>(u), static_cast<int>(v));
      for (std::uint32_t c = 0; c < 3; ++c) {
        const std::uint32_t from = channels == 1 ? 0 : (reversed ? 2 - c : c);
        pixel[c] = static_cast<std::uint8_t>(row[channels * u + from]);
      }
    }
  }
  return color;
}

class ImageExport : public TopicExport {
 public:
  ImageExport(MessageType type, std::filesystem::path folder)
      : type_(std::move(type)), folder_(std::move(folder)) {}

  std::string Take(const recording::Message& message) override {
    RosImage image;
    if (!ReadImage(message.data, type_, &image)) return "is no whole image";
    if (image.width == 0 || image.height == 0) {
      return "is empty: " + std::to_string(image.width) + " x " + std::to_string(image.height);
    }
    const bool is_depth = image.encoding == "16UC1" || image.encoding == "mono16";
    const bool is_grey = image.encoding == "mono8" || image.encoding == "8UC1";
    const bool is_color = image.encoding == "rgb8" || image.encoding == "bgr8";
    if (!is_depth && !is_grey && !is_color) {
      return "encoding '" + image.encoding + "' cannot be a PNG (16UC1, mono16, mono8, rgb8, bgr8)";
    }
    const std::uint32_t pixel_bytes = is_depth ? 2 : (is_color ? 3 : 1);
    if (image.step < std::uint64_t{pixel_bytes} * image.width) return "its rows are too short";
    std::filesystem::create_directories(folder_);
    const auto file = folder_ / (std::to_string(StampOf(message, type_)) + ".png");
    if (is_depth) {
      rgbd::WriteDepthPng(file, DepthOf(image));
    } else {
      rgbd::WriteColorPng(file, ColorOf(image, pixel_bytes, image.encoding == "bgr8"));
    }
    return {};
  }

 private:
  MessageType type_;
  std::filesystem::path folder_;
};

}  // namespace

std::unique_ptr<TopicExport> MakeImageExport(MessageType type, std::filesystem::path folder) {
  return std::make_unique<ImageExport>(std::move(type), std::move(folder));
}

}  // namespace palpate::command
