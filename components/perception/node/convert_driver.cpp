// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/convert_driver.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "components/perception/node/convert.hpp"
#include "libs/dds/invalid_message.hpp"
#include "libs/dds/message.hpp"
#include "libs/rgbd/ros_formats.hpp"

namespace palpate::perception {

namespace {

using dds::Invalid;
using idl::sensor_msgs::CameraInfo;
using idl::sensor_msgs::Image;

Status UnknownEncoding(const Image& message, const std::string& known) {
  return Invalid("encoding '" + std::string(dds::Text(message.encoding)) +
                 (message.is_bigendian ? "', big-endian," : "'") + " instead of " + known);
}

const std::uint8_t* Row(const Image& message, int v) {
  return message.data._buffer + static_cast<std::size_t>(v) * message.step;
}

Status CopyRaw(const Image& message, rgbd::DepthImage* image) {
  if (Status status = CheckImageSize(message, sizeof(std::uint16_t)); !status.ok()) return status;
  *image = rgbd::DepthImage(static_cast<int>(message.width), static_cast<int>(message.height));
  for (int v = 0; v < image->height_px; ++v) {
    std::memcpy(image->Pixel(0, v), Row(message, v), sizeof(std::uint16_t) * message.width);
  }
  return Status::Ok();
}

Status CopyMetres(const Image& message, double largest_z_m, double unit_m,
                  rgbd::DepthImage* image) {
  if (Status status = CheckImageSize(message, sizeof(float)); !status.ok()) return status;
  *image = rgbd::DepthImage(static_cast<int>(message.width), static_cast<int>(message.height));
  const auto largest_m = static_cast<float>(largest_z_m);
  const auto steps_per_m = static_cast<float>(1.0 / unit_m);
  for (int v = 0; v < image->height_px; ++v) {
    const std::uint8_t* from = Row(message, v);
    std::uint16_t* to = image->Pixel(0, v);
    for (std::size_t u = 0; u < message.width; ++u) {
      float z_m = 0.0f;
      std::memcpy(&z_m, from + u * sizeof(float), sizeof(float));
      const bool valid = z_m > 0.0f && z_m <= largest_m;  // false for NaN, too
      to[u] = valid ? static_cast<std::uint16_t>(std::lround(z_m * steps_per_m)) : std::uint16_t{0};
    }
  }
  return Status::Ok();
}

}  // namespace

Status FromDriverDepth(const Image& message, double unit_16bit_m, double largest_z_m,
                       rgbd::DepthImage* image, double* unit_m) {
  const std::string_view encoding = dds::Text(message.encoding);
  if (!message.is_bigendian && (encoding == "16UC1" || encoding == "mono16")) {
    *unit_m = unit_16bit_m;
    return CopyRaw(message, image);
  }
  if (!message.is_bigendian && encoding == "32FC1") {
    *unit_m = largest_z_m / std::numeric_limits<std::uint16_t>::max();
    return CopyMetres(message, largest_z_m, *unit_m, image);
  }
  return UnknownEncoding(message, "16UC1 (mm) or 32FC1 (m)");
}

Status FromDriverColor(const Image& message, rgbd::ColorImage* image) {
  const std::string_view encoding = dds::Text(message.encoding);
  const rgbd::ColorLayout* layout = rgbd::ColorLayoutOf(encoding);
  if (layout == nullptr) {
    return UnknownEncoding(message, "rgb8, bgr8, rgba8, bgra8 or mono8");
  }
  if (Status status = CheckImageSize(message, layout->pixel_bytes); !status.ok()) return status;
  *image = rgbd::ColorImage(static_cast<int>(message.width), static_cast<int>(message.height));
  for (int v = 0; v < image->height_px; ++v) {
    const std::uint8_t* from = Row(message, v);
    std::uint8_t* to = image->Pixel(0, v);
    for (int u = 0; u < image->width_px; ++u, from += layout->pixel_bytes) {
      for (const std::size_t byte : layout->rgb) *to++ = from[byte];
    }
  }
  return Status::Ok();
}

Status FromDriverInfo(const CameraInfo& message, bool rectified, rgbd::CameraModel* camera) {
  idl::sensor_msgs::CameraInfo pinhole = message;
  pinhole.d._length = 0;
  if (rectified) {
    const double from_p[9] = {message.p[0], message.p[1], message.p[2], message.p[4], message.p[5],
                              message.p[6], message.p[8], message.p[9], message.p[10]};
    std::copy_n(from_p, 9, pinhole.k);
  }
  if (Status status = FromCameraInfo(pinhole, camera); !status.ok() || rectified) return status;
  const auto distortion = rgbd::DistortionOf(dds::Text(message.distortion_model),
                                             {message.d._buffer, message.d._length});
  if (!distortion) {
    return Invalid("distortion model '" + std::string(dds::Text(message.distortion_model)) +
                   "' with " + std::to_string(message.d._length) +
                   " numbers instead of plumb_bob with 5: take the driver's rectified image "
                   "(.../image_rect)");
  }
  camera->distortion = *distortion;
  return Status::Ok();
}

}  // namespace palpate::perception
