// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "components/offline/messages/message_type.hpp"
#include "libs/rgbd/image.hpp"
#include "libs/rgbd/ros_compressed.hpp"

namespace palpate::offline {

/// A sensor_msgs/Image, or CompressedImage. The data stay in the message.
struct RosImage {
  std::string frame_id;
  std::uint32_t height = 0;  ///< 0 of a compressed image, as the next four
  std::uint32_t width = 0;
  std::uint32_t step = 0;
  bool big_endian = false;
  std::string encoding;  ///< "16UC1"; of a compressed image what its format begins with, or empty
  std::string format;    ///< of a compressed image: "rgb8; jpeg compressed bgr8"; else empty
  std::string_view data;

  bool compressed() const { return !format.empty(); }
  /// 16UC1, mono16, 32FC1, and what image_transport packs as compressedDepth.
  bool IsDepth() const;
  /// rgb8, bgr8, rgba8, bgra8 and packed images that do not say that they are grey.
  bool IsColor() const;
  std::string_view Row(std::uint32_t v) const { return data.substr(std::size_t{v} * step, step); }
};

inline constexpr char kImageType[] = "sensor_msgs/msg/Image";
inline constexpr char kCompressedImageType[] = "sensor_msgs/msg/CompressedImage";

/// Empty: done; else why the message is no image.
[[nodiscard]] std::string ReadImage(std::string_view cdr, const MessageType& type, RosImage* image);

using rgbd::RosDepth;

/// Empty: done; else why not. `image` must be depth.
[[nodiscard]] std::string DecodeRosDepth(const RosImage& image, RosDepth* depth);

/// Empty: done; else why not. Also takes mono8 and 8UC1, as grey.
[[nodiscard]] std::string DecodeRosColor(const RosImage& image, rgbd::ColorImage* color);

}  // namespace palpate::offline
