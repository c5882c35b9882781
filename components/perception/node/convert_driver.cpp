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
#include <utility>

#include "components/perception/node/convert.hpp"
#include "libs/dds/camera_messages.hpp"
#include "libs/dds/invalid_message.hpp"
#include "libs/dds/message.hpp"
#include "libs/rgbd/ros_compressed.hpp"
#include "libs/rgbd/ros_formats.hpp"

namespace palpate::perception {

namespace {

using dds::Invalid;
using idl::sensor_msgs::CameraInfo;
using idl::sensor_msgs::CompressedImage;
using idl::sensor_msgs::Image;

Status UnknownEncoding(const Image& message, const std::string& known) {
  return Invalid("encoding '" + std::string(dds::Text(message.encoding)) +
                 (message.is_bigendian ? "', big-endian," : "'") + " instead of " + known);
}

const std::uint8_t* Row(const Image& message, int v) {
  return message.data._buffer + static_cast<std::size_t>(v) * message.step;
}

Status CopyRaw(const Image& message, rgbd::DepthImage* image) {
  if (Status status = dds::CheckImageSize(message, sizeof(std::uint16_t)); !status.ok())
    return status;
  *image = rgbd::DepthImage(static_cast<int>(message.width), static_cast<int>(message.height));
  for (int v = 0; v < image->height_px; ++v) {
    std::memcpy(image->Pixel(0, v), Row(message, v), sizeof(std::uint16_t) * message.width);
  }
  return Status::Ok();
}

/// Metres in steps; 0 where nothing is seen, or beyond the range.
class DepthSteps {
 public:
  DepthSteps(double largest_z_m, double unit_m)
      : largest_m_(static_cast<float>(largest_z_m)),
        steps_per_m_(static_cast<float>(1.0 / unit_m)) {}

  std::uint16_t Of(float z_m) const {
    const bool valid = z_m > 0.0f && z_m <= largest_m_;  // false for NaN, too
    return valid ? static_cast<std::uint16_t>(std::lround(z_m * steps_per_m_)) : std::uint16_t{0};
  }

 private:
  float largest_m_;
  float steps_per_m_;
};

double UnitOfMetres_m(double largest_z_m) {
  return largest_z_m / std::numeric_limits<std::uint16_t>::max();
}

std::string_view DataOf(const CompressedImage& message) {
  return {reinterpret_cast<const char*>(message.data._buffer), message.data._length};
}

Status CopyMetres(const Image& message, double largest_z_m, double unit_m,
                  rgbd::DepthImage* image) {
  if (Status status = dds::CheckImageSize(message, sizeof(float)); !status.ok()) return status;
  *image = rgbd::DepthImage(static_cast<int>(message.width), static_cast<int>(message.height));
  const DepthSteps steps(largest_z_m, unit_m);
  for (int v = 0; v < image->height_px; ++v) {
    const std::uint8_t* from = Row(message, v);
    std::uint16_t* to = image->Pixel(0, v);
    for (std::size_t u = 0; u < message.width; ++u) {
      float z_m = 0.0f;
      std::memcpy(&z_m, from + u * sizeof(float), sizeof(float));
      to[u] = steps.Of(z_m);
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
    *unit_m = UnitOfMetres_m(largest_z_m);
    return CopyMetres(message, largest_z_m, *unit_m, image);
  }
  return UnknownEncoding(message, "16UC1 (mm) or 32FC1 (m)");
}

Status FromDriverDepth(const CompressedImage& message, double unit_16bit_m, double largest_z_m,
                       rgbd::DepthImage* image, double* unit_m) {
  rgbd::RosDepth depth;
  const std::string cause =
      rgbd::DecodeCompressedDepth(dds::Text(message.format), DataOf(message), &depth);
  if (!cause.empty()) return Invalid("a packed depth image: " + cause);
  *unit_m = depth.range_m.empty() ? unit_16bit_m : UnitOfMetres_m(largest_z_m);
  *image = std::move(depth.steps);
  if (depth.range_m.empty()) return Status::Ok();
  *image = rgbd::DepthImage(depth.width_px, depth.height_px);
  const DepthSteps steps(largest_z_m, *unit_m);
  std::transform(depth.range_m.begin(), depth.range_m.end(), image->values.begin(),
                 [&](float z_m) { return steps.Of(z_m); });
  return Status::Ok();
}

Status FromDriverColor(const CompressedImage& message, rgbd::ColorImage* image) {
  const std::string cause = rgbd::DecodeCompressedColor(DataOf(message), image);
  return cause.empty() ? Status::Ok() : Invalid("a packed colour image: " + cause);
}

Status FromDriverColor(const Image& message, rgbd::ColorImage* image) {
  const std::string_view encoding = dds::Text(message.encoding);
  const rgbd::ColorLayout* layout = rgbd::ColorLayoutOf(encoding);
  if (layout == nullptr) {
    return UnknownEncoding(message, "rgb8, bgr8, rgba8, bgra8 or mono8");
  }
  if (Status status = dds::CheckImageSize(message, layout->pixel_bytes); !status.ok())
    return status;
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
  if (Status status = dds::FromCameraInfo(pinhole, camera); !status.ok() || rectified)
    return status;
  const auto distortion = rgbd::DistortionOf(dds::Text(message.distortion_model),
                                             {message.d._buffer, message.d._length});
  if (!distortion) {
    return Invalid("distortion model '" + std::string(dds::Text(message.distortion_model)) +
                   "' with " + std::to_string(message.d._length) +
                   " numbers instead of plumb_bob with 5 or rational_polynomial with 8: take the "
                   "driver's rectified image (.../image_rect)");
  }
  camera->distortion = *distortion;
  return Status::Ok();
}

}  // namespace palpate::perception
