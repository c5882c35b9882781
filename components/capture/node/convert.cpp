// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/node/convert.hpp"

#include <algorithm>
#include <limits>

#include "libs/core/check.hpp"
#include "libs/core/sha256.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"

namespace palpate::capture {

namespace {

std::string_view DepthFrameId() { return geometry::kCameraDepthOpticalFrame; }

std::string CalibrationHash(const rgbd::RgbdCamera& camera, const SourceHealth& health,
                            double subpixel_sigma_px) {
  return Sha256Hex(health.device + "\n" + health.model + "\n" + FormatNumber(subpixel_sigma_px) +
                   "\n" + rgbd::FormatCameraFile(camera));
}

}  // namespace

std::string_view ColorFrameId(const rgbd::RgbdCamera& camera) {
  return camera.color_registered ? DepthFrameId() : geometry::kCameraColorOpticalFrame;
}

std::string_view NameOf(ClockSource source) {
  switch (source) {
    case ClockSource::kHostReceive: return "host_receive";
    case ClockSource::kDeviceMapped: return "device_mapped";
    case ClockSource::kPtp: return "ptp";
    case ClockSource::kReplay: return "replay";
  }
  PALPATE_CHECK(false, static_cast<int>(source));
  return "";
}

std::string_view NameOf(SourceState state) {
  switch (state) {
    case SourceState::kDiscover: return "discover";
    case SourceState::kOpen: return "open";
    case SourceState::kConfigure: return "configure";
    case SourceState::kStream: return "stream";
    case SourceState::kStale: return "stale";
    case SourceState::kLost: return "lost";
    case SourceState::kEnded: return "ended";
  }
  PALPATE_CHECK(false, static_cast<int>(state));
  return "";
}

ImageMessage::ImageMessage(std::string_view encoding, std::uint32_t bytes_per_pixel)
    : bytes_per_pixel_(bytes_per_pixel) {
  dds::SetText(message_->encoding, encoding);
  message_->data._release = false;
}

const idl::sensor_msgs::Image& ImageMessage::Point(const std::uint8_t* pixels, int width_px,
                                                   int height_px, std::int64_t stamp_ns,
                                                   std::string_view frame_id) {
  message_->header.stamp = dds::TimeFromNs(stamp_ns);
  if (dds::Text(message_->header.frame_id) != frame_id) {
    dds::SetText(message_->header.frame_id, frame_id);
  }
  message_->width = static_cast<std::uint32_t>(width_px);
  message_->height = static_cast<std::uint32_t>(height_px);
  message_->step = message_->width * bytes_per_pixel_;
  message_->data._length = message_->data._maximum = message_->step * message_->height;
  // DDS only reads what it sends.
  message_->data._buffer = const_cast<std::uint8_t*>(pixels);
  return *message_;
}

dds::Message<idl::sensor_msgs::CameraInfo> ToCameraInfo(const rgbd::CameraModel& camera,
                                                        std::int64_t stamp_ns,
                                                        std::string_view frame_id) {
  dds::Message<idl::sensor_msgs::CameraInfo> info;
  dds::SetHeader(info->header, stamp_ns, frame_id);
  info->width = static_cast<std::uint32_t>(camera.width_px);
  info->height = static_cast<std::uint32_t>(camera.height_px);
  dds::SetText(info->distortion_model, "plumb_bob");
  dds::SetNumbers(info->d, camera.distortion.data(), camera.distortion.size());
  info->r[0] = info->r[4] = info->r[8] = 1.0;
  if (camera.fx_px <= 0.0) return info;
  info->k[0] = info->p[0] = camera.fx_px;
  info->k[2] = info->p[2] = camera.cx_px;
  info->k[4] = info->p[5] = camera.fy_px;
  info->k[5] = info->p[6] = camera.cy_px;
  info->k[8] = info->p[10] = 1.0;
  return info;
}

dds::Message<idl::palpate_msgs::CameraSetup> ToCameraSetup(const rgbd::RgbdCamera& camera,
                                                           const SourceHealth& health,
                                                           std::uint32_t epoch,
                                                           std::int64_t stamp_ns,
                                                           double subpixel_sigma_px) {
  dds::Message<idl::palpate_msgs::CameraSetup> setup;
  dds::SetHeader(setup->header, stamp_ns, DepthFrameId());
  setup->epoch = epoch;
  dds::SetText(setup->device, health.device);
  dds::SetText(setup->model, health.model);
  setup->depth_unit_m = camera.depth_unit_m;
  setup->invalid_value = static_cast<std::uint32_t>(camera.invalid_value);
  setup->baseline_m = camera.baseline_m;
  setup->subpixel_sigma_px =
      subpixel_sigma_px > 0.0 ? subpixel_sigma_px : std::numeric_limits<double>::quiet_NaN();
  setup->color_registered = camera.color_registered;
  setup->color_in_depth = dds::ToPose(camera.T_depth_color);
  dds::SetText(setup->calibration_hash, CalibrationHash(camera, health, subpixel_sigma_px));
  return setup;
}

void SetFrameInfo(const SourceFrame& frame, const SourceHealth& health, std::uint64_t counter,
                  idl::palpate_msgs::FrameInfo* message) {
  const FrameFacts& facts = frame.facts;
  message->header.stamp = dds::TimeFromNs(facts.stamp_host_ns);
  if (dds::Text(message->header.frame_id) != DepthFrameId()) {
    dds::SetText(message->header.frame_id, DepthFrameId());
  }
  if (dds::Text(message->device) != health.device) dds::SetText(message->device, health.device);
  if (dds::Text(message->clock_source) != NameOf(facts.clock_source)) {
    dds::SetText(message->clock_source, NameOf(facts.clock_source));
  }
  message->counter = counter;
  message->frame_id = facts.frame_id;
  message->epoch = facts.epoch;
  message->stamp_device_ns = facts.stamp_device_ns;
  message->stamp_host_ns = facts.stamp_host_ns;
  message->stamp_receive_ns = facts.stamp_receive_ns;
  message->pairing_difference_ns = facts.pairing_difference_ns;
  message->exposure_s = facts.exposure_s;
  message->gain_db = facts.gain_dB;
  message->temperature_deg_c = facts.temperature_degC;
  message->depth_unit_m = frame.camera->depth_unit_m;
  message->invalid_value = static_cast<std::uint32_t>(frame.camera->invalid_value);
  message->valid_ratio = facts.valid_ratio;
  message->packets_lost = facts.packets_lost;
  message->packets_resent = facts.packets_resent;
  message->frames_failed = health.frames_failed;
  message->frames_dropped = health.frames_dropped;
  message->socket_drops = health.socket_drops;
}

}  // namespace palpate::capture
