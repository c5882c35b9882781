// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/camera_messages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libs/core/sha256.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/invalid_message.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"
#include "libs/rgbd/ros_formats.hpp"

namespace palpate::dds {

namespace {

using idl::sensor_msgs::CameraInfo;
using idl::sensor_msgs::Image;

constexpr std::uint32_t kLargestSide_px = 16384;

bool IsSide(std::uint32_t length_px) { return length_px > 0 && length_px <= kLargestSide_px; }

bool AllFinite(const double* numbers, std::size_t count) {
  return std::all_of(numbers, numbers + count, [](double x) { return std::isfinite(x); });
}

Status ReadDistortion(const CameraInfo& message, rgbd::CameraModel* camera) {
  const std::string_view model = Text(message.distortion_model);
  const auto distortion = rgbd::DistortionOf(model, {message.d._buffer, message.d._length});
  if (!distortion) {
    return Invalid("distortion model '" + std::string(model) + "' with " +
                   std::to_string(message.d._length) +
                   " numbers instead of 'plumb_bob' with 5 finite ones or 'rational_polynomial' "
                   "with 8");
  }
  camera->distortion = *distortion;
  return Status::Ok();
}

std::string CalibrationHash(const rgbd::RgbdCamera& camera, const CameraIdentity& identity) {
  return Sha256Hex(identity.device + "\n" + identity.model + "\n" +
                   FormatNumber(identity.subpixel_sigma_px) + "\n" +
                   rgbd::FormatCameraFile(camera));
}

}  // namespace

std::string_view ColorFrameId(const rgbd::RgbdCamera& camera) {
  return camera.color_registered ? geometry::kCameraDepthOpticalFrame
                                 : geometry::kCameraColorOpticalFrame;
}

ImageMessage::ImageMessage(std::string_view encoding, std::uint32_t bytes_per_pixel)
    : bytes_per_pixel_(bytes_per_pixel) {
  SetText(message_->encoding, encoding);
  message_->data._release = false;
}

const idl::sensor_msgs::Image& ImageMessage::Point(const std::uint8_t* pixels, int width_px,
                                                   int height_px, std::int64_t stamp_ns,
                                                   std::string_view frame_id) {
  message_->header.stamp = TimeFromNs(stamp_ns);
  if (Text(message_->header.frame_id) != frame_id) {
    SetText(message_->header.frame_id, frame_id);
  }
  message_->width = static_cast<std::uint32_t>(width_px);
  message_->height = static_cast<std::uint32_t>(height_px);
  message_->step = message_->width * bytes_per_pixel_;
  message_->data._length = message_->data._maximum = message_->step * message_->height;
  // DDS only reads what it sends.
  message_->data._buffer = const_cast<std::uint8_t*>(pixels);
  return *message_;
}

Message<idl::sensor_msgs::CameraInfo> ToCameraInfo(const rgbd::CameraModel& camera,
                                                   std::int64_t stamp_ns,
                                                   std::string_view frame_id) {
  Message<idl::sensor_msgs::CameraInfo> info;
  SetHeader(info->header, stamp_ns, frame_id);
  info->width = static_cast<std::uint32_t>(camera.width_px);
  info->height = static_cast<std::uint32_t>(camera.height_px);
  SetText(info->distortion_model, camera.rational() ? "rational_polynomial" : "plumb_bob");
  SetNumbers(info->d, camera.coefficients().data(), camera.coefficients().size());
  info->r[0] = info->r[4] = info->r[8] = 1.0;
  if (camera.fx_px <= 0.0) return info;
  info->k[0] = info->p[0] = camera.fx_px;
  info->k[2] = info->p[2] = camera.cx_px;
  info->k[4] = info->p[5] = camera.fy_px;
  info->k[5] = info->p[6] = camera.cy_px;
  info->k[8] = info->p[10] = 1.0;
  return info;
}

Message<idl::palpate_msgs::CameraSetup> ToCameraSetup(const rgbd::RgbdCamera& camera,
                                                      const CameraIdentity& identity,
                                                      std::int64_t stamp_ns,
                                                      std::string_view depth_frame) {
  Message<idl::palpate_msgs::CameraSetup> setup;
  SetHeader(setup->header, stamp_ns, depth_frame);
  setup->epoch = identity.epoch;
  SetText(setup->device, identity.device);
  SetText(setup->model, identity.model);
  setup->depth_unit_m = camera.depth_unit_m;
  setup->invalid_value = static_cast<std::uint32_t>(camera.invalid_value);
  setup->baseline_m = camera.baseline_m;
  setup->subpixel_sigma_px = identity.subpixel_sigma_px > 0.0
                                 ? identity.subpixel_sigma_px
                                 : std::numeric_limits<double>::quiet_NaN();
  setup->color_registered = camera.color_registered;
  setup->color_in_depth = ToPose(camera.T_depth_color);
  SetText(setup->calibration_hash, CalibrationHash(camera, identity));
  return setup;
}

Status CheckImageSize(const Image& message, std::uint32_t pixel_bytes) {
  const bool sized = IsSide(message.width) && IsSide(message.height);
  const bool filled = message.step >= message.width * pixel_bytes &&
                      message.data._length >= std::uint64_t{message.step} * message.height;
  if (!sized || !filled) {
    return Invalid("an image of " + std::to_string(message.width) + " x " +
                   std::to_string(message.height) + " pixels in " +
                   std::to_string(message.data._length) + " bytes");
  }
  return Status::Ok();
}

Status FromCameraInfo(const CameraInfo& message, rgbd::CameraModel* camera) {
  rgbd::CameraModel lens;
  if (!IsSide(message.width) || !IsSide(message.height)) {
    return Invalid("a camera of " + std::to_string(message.width) + " x " +
                   std::to_string(message.height) + " pixels");
  }
  lens.width_px = static_cast<int>(message.width);
  lens.height_px = static_cast<int>(message.height);
  if (!AllFinite(message.k, 9) || message.k[0] < 0.0 || message.k[4] < 0.0) {
    return Invalid("intrinsics that are no numbers of a camera");
  }
  lens.fx_px = message.k[0];
  lens.cx_px = message.k[2];
  lens.fy_px = message.k[4];
  lens.cy_px = message.k[5];
  if (Status status = ReadDistortion(message, &lens); !status.ok()) return status;
  *camera = lens;
  return Status::Ok();
}

}  // namespace palpate::dds
