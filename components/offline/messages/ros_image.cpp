// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/messages/ros_image.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "libs/rgbd/ros_formats.hpp"

namespace palpate::offline {

namespace {

bool IsDepthEncoding(const std::string& encoding) {
  return encoding == "16UC1" || encoding == "mono16" || encoding == "32FC1";
}

std::string CheckSize(const RosImage& image, std::uint32_t pixel_bytes) {
  if (image.width == 0 || image.height == 0) {
    return "is empty: " + std::to_string(image.width) + " x " + std::to_string(image.height);
  }
  constexpr std::uint32_t kLargest_px = 1u << 16;
  if (image.width > kLargest_px || image.height > kLargest_px) return "is no whole image";
  if (image.step < std::uint64_t{pixel_bytes} * image.width) return "its rows are too short";
  if (image.data.size() < std::uint64_t{image.step} * image.height) return "is no whole image";
  return {};
}

template <typename Bits>
Bits BitsAt(const RosImage& image, std::string_view row, std::uint32_t u) {
  Bits bits = 0;
  for (std::size_t i = 0; i < sizeof(Bits); ++i) {
    const std::size_t place = image.big_endian ? sizeof(Bits) - 1 - i : i;
    const auto byte = static_cast<std::uint8_t>(row[u * sizeof(Bits) + place]);
    bits = static_cast<Bits>(bits | static_cast<Bits>(byte) << (8 * i));
  }
  return bits;
}

void CopySteps(const RosImage& image, RosDepth* depth) {
  depth->steps = rgbd::DepthImage(depth->width_px, depth->height_px);
  std::uint16_t* to = depth->steps.values.data();
  for (std::uint32_t v = 0; v < image.height; ++v) {
    const std::string_view row = image.Row(v);
    for (std::uint32_t u = 0; u < image.width; ++u) *to++ = BitsAt<std::uint16_t>(image, row, u);
  }
}

void CopyMetres(const RosImage& image, RosDepth* depth) {
  depth->range_m.reserve(std::size_t{image.width} * image.height);
  for (std::uint32_t v = 0; v < image.height; ++v) {
    const std::string_view row = image.Row(v);
    for (std::uint32_t u = 0; u < image.width; ++u) {
      const float z_m = std::bit_cast<float>(BitsAt<std::uint32_t>(image, row, u));
      const bool seen = std::isfinite(z_m) && z_m > 0.0f;
      depth->range_m.push_back(seen ? z_m : std::numeric_limits<float>::quiet_NaN());
    }
  }
}

}  // namespace

bool RosImage::IsDepth() const {
  return IsDepthEncoding(encoding) || format.find("compressedDepth") != std::string::npos;
}

bool RosImage::IsColor() const {
  if (IsDepth()) return false;
  if (compressed() && encoding.empty()) return true;
  const rgbd::ColorLayout* layout = rgbd::ColorLayoutOf(encoding);
  return layout != nullptr && layout->pixel_bytes > 1;
}

std::string ReadImage(std::string_view cdr, const MessageType& type, RosImage* image) {
  *image = {};
  recording::CdrReader reader = type.At("header", cdr);
  reader.Stamp_ns();
  image->frame_id = reader.String();
  if (type.name == kCompressedImageType) {
    image->format = reader.String();
    image->data = reader.Array(reader.Length(), 1);
    if (!reader.ok() || image->data.empty()) return "is no whole image";
    const std::size_t end = image->format.find(';');
    if (end != std::string::npos) image->encoding = image->format.substr(0, end);
    if (image->format.empty()) image->format = "unknown";
    return {};
  }
  image->height = reader.Length();
  image->width = reader.Length();
  image->encoding = reader.String();
  image->big_endian = reader.Bits(1) != 0;
  image->step = reader.Length();
  image->data = reader.Array(reader.Length(), 1);
  const bool whole =
      reader.ok() && image->data.size() >= std::uint64_t{image->step} * image->height;
  return whole ? "" : "is no whole image";
}

std::string DecodeRosDepth(const RosImage& image, RosDepth* depth) {
  *depth = {};
  if (image.compressed()) return rgbd::DecodeCompressedDepth(image.format, image.data, depth);
  const bool metres = image.encoding == "32FC1";
  if (std::string cause = CheckSize(image, metres ? 4 : 2); !cause.empty()) return cause;
  depth->width_px = static_cast<int>(image.width);
  depth->height_px = static_cast<int>(image.height);
  metres ? CopyMetres(image, depth) : CopySteps(image, depth);
  return {};
}

std::string DecodeRosColor(const RosImage& image, rgbd::ColorImage* color) {
  if (image.compressed()) return rgbd::DecodeCompressedColor(image.data, color);
  const rgbd::ColorLayout* layout = rgbd::ColorLayoutOf(image.encoding);
  if (layout == nullptr) {
    return "encoding '" + image.encoding + "' is not known (rgb8, bgr8, rgba8, bgra8, mono8)";
  }
  if (std::string cause = CheckSize(image, layout->pixel_bytes); !cause.empty()) return cause;
  *color = rgbd::ColorImage(static_cast<int>(image.width), static_cast<int>(image.height));
  std::uint8_t* to = color->values.data();
  for (std::uint32_t v = 0; v < image.height; ++v) {
    const std::string_view row = image.Row(v);
    for (std::uint32_t u = 0; u < image.width; ++u) {
      for (const std::size_t byte : layout->rgb) {
        *to++ = static_cast<std::uint8_t>(row[u * layout->pixel_bytes + byte]);
      }
    }
  }
  return {};
}

}  // namespace palpate::offline
