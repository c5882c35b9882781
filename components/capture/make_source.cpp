// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/make_source.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "components/capture/genicam_source.hpp"
#include "components/capture/network/packet_size.hpp"
#include "components/capture/replay/replay_source.hpp"
#include "libs/core/error.hpp"

namespace palpate::capture {

namespace {

void CheckCount(const std::vector<double>& numbers, std::size_t count, const std::string& key) {
  if (numbers.empty() || numbers.size() == count) return;
  throw InputError(key + ": " + std::to_string(count) + " numbers or none, not " +
                   std::to_string(numbers.size()));
}

void CheckDistortion(const std::vector<double>& numbers, const std::string& key) {
  if (numbers.empty() || numbers.size() == 5 || numbers.size() == 8) return;
  throw InputError(key + ": 5 numbers, 8 of a rational model, or none, not " +
                   std::to_string(numbers.size()));
}

void CheckLens(const LensConfig& lens, const std::string& key) {
  CheckDistortion(lens.distortion, key + ".distortion");
  CheckCount(lens.intrinsics_px, 4, key + ".intrinsics_px");
  if (lens.intrinsics_px.empty()) return;
  if (lens.intrinsics_px[0] < 1.0 || lens.intrinsics_px[1] < 1.0) {
    throw InputError(key + ".intrinsics_px: focal lengths must be 1 px or more");
  }
}

/// One of fx, fy, cx, cy, where they are given.
std::optional<double> Intrinsic(const LensConfig& lens, std::size_t index) {
  if (lens.intrinsics_px.empty()) return std::nullopt;
  return lens.intrinsics_px[index];
}

std::optional<Eigen::Isometry3d> PoseOf(const std::vector<double>& numbers) {
  CheckCount(numbers, 7, "color_pose");
  if (numbers.empty()) return std::nullopt;
  const Eigen::Quaterniond rotation(numbers[6], numbers[3], numbers[4], numbers[5]);
  if (std::abs(rotation.norm() - 1.0) > 1e-3) {
    throw InputError("color_pose: the quaternion must have norm 1");
  }
  Eigen::Isometry3d pose(rotation.normalized());
  pose.translation() = Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
  return pose;
}

ColorOverrides ColorOf(const Config& config) {
  ColorOverrides color;
  color.fx_px = Intrinsic(config.color, 0);
  color.fy_px = Intrinsic(config.color, 1);
  color.cx_px = Intrinsic(config.color, 2);
  color.cy_px = Intrinsic(config.color, 3);
  color.distortion = config.color.distortion;
  if (config.color_registered != "as_told") color.registered = config.color_registered == "yes";
  color.T_depth_color = PoseOf(config.color_pose);
  return color;
}

LinkSettings LinkOf(const Config& config) {
  const GenicamConfig& genicam = config.genicam;
  LinkSettings link;
  link.target = {.id = genicam.camera_id,
                 .interface_address = genicam.interface_address,
                 .fake = config.source == "fake",
                 .fake_description = ""};
  link.wishes.depth_format = genicam.depth_format;
  link.wishes.color_format = genicam.color_format;
  link.wishes.exposure_s = genicam.exposure_s;
  link.wishes.gain_dB = genicam.gain_dB;
  link.wishes.frame_rate_Hz = genicam.frame_rate_Hz;
  link.wishes.trigger_source = genicam.trigger_source;
  if (genicam.packet_delay_ns > 0) link.wishes.packet_delay_ns = genicam.packet_delay_ns;
  link.wishes.scan3d = {.fx_px = Intrinsic(config.depth, 0),
                        .fy_px = Intrinsic(config.depth, 1),
                        .cx_px = Intrinsic(config.depth, 2),
                        .cy_px = Intrinsic(config.depth, 3),
                        .baseline_m = config.baseline_m,
                        .distance_unit_m = config.distance_unit_m,
                        .scale_c = config.coordinate_scale,
                        .distortion = config.depth.distortion};
  link.stream.socket_buffer_bytes = genicam.socket_buffer_bytes;
  link.stream.packet_size_bytes = genicam.packet_size_bytes;
  link.stream.packet_resend = genicam.packet_resend;
  link.stream.packet_socket = genicam.packet_socket;
  link.depth_unit_m = config.depth_unit_m;
  // Those that wait, those of an unfinished pair, the one that is filled, two in readers' hands.
  link.pool_frames = static_cast<std::size_t>(config.queue_frames) + 11;
  return link;
}

GenicamSettings GenicamOf(const Config& config) {
  const std::string& interface = config.genicam.interface_address;
  if (!interface.empty() && !IsIpv4Address(interface)) {
    throw InputError("genicam.interface_address: an IPv4 address, not '" + interface + "'");
  }
  GenicamSettings settings;
  settings.depth = LinkOf(config);
  settings.color_overrides = ColorOf(config);
  settings.queue_frames = static_cast<std::size_t>(config.queue_frames);
  if (config.genicam.color_camera_id.empty()) return settings;
  if (config.genicam.camera_id.empty()) {
    throw InputError("genicam.color_camera_id: needs genicam.camera_id, the depth camera, as well");
  }
  settings.color = settings.depth;
  settings.color->target.id = config.genicam.color_camera_id;
  settings.color->wishes.role = DeviceRole::kColorOnly;
  settings.depth.wishes.role = DeviceRole::kDepthOnly;
  return settings;
}

}  // namespace

std::unique_ptr<FrameSource> MakeSource(const Config& config, const ConfigLoader& load) {
  CheckLens(config.depth, "depth");
  CheckLens(config.color, "color");
  if (config.source != "replay") return std::make_unique<GenicamSource>(GenicamOf(config));
  return std::make_unique<ReplaySource>(config.replay,
                                        static_cast<std::size_t>(config.queue_frames), load);
}

}  // namespace palpate::capture
