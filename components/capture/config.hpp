// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "libs/core/config_reader.hpp"

namespace palpate::capture {

/// Settings that override what the camera reports of one lens.
struct LensConfig {
  std::vector<double> intrinsics_px;
  std::vector<double> distortion;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("intrinsics_px", intrinsics_px, {.min = -1e5, .max = 1e5},
      "fx, fy, cx, cy; pixel 0 has its centre at 0; empty: the camera's");
    v("distortion", distortion, {.min = -100.0, .max = 100.0},
      "k1, k2, p1, p2, k3 and, of a rational model, k4, k5, k6; empty: the camera's, or none");
  }
};

/// A GenICam camera and its transport.
struct GenicamConfig {
  std::string camera_id;
  std::string color_camera_id;
  std::string interface_address;
  std::string depth_format;
  std::string color_format;
  std::optional<double> exposure_s;
  std::optional<double> gain_dB;
  std::optional<double> frame_rate_Hz;
  std::string trigger_source;
  int socket_buffer_bytes = 16 << 20;
  int packet_size_bytes = 0;
  int packet_delay_ns = 0;
  bool packet_resend = true;
  bool packet_socket = false;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("camera_id", camera_id,
      "IPv4 address, vendor-serial, serial number or MAC; empty: the only camera there is");
    v("color_camera_id", color_camera_id,
      "A second camera for the colour, paired by time; empty: colour comes with the depth");
    v("interface_address", interface_address,
      "IPv4 of this host's interface to the camera; empty: chosen by the routing table");
    v("depth_format", depth_format, "GenICam pixel format; empty: the camera's, if it is decoded");
    v("color_format", color_format, "GenICam pixel format; empty: the camera's, if it is decoded");
    v("exposure_s", exposure_s, {.min = 0.0, .max = 10.0, .min_open = true},
      "Exposure time; unset: unchanged");
    v("gain_dB", gain_dB, {.min = 0.0, .max = 100.0}, "Gain; unset: unchanged");
    v("frame_rate_Hz", frame_rate_Hz, {.min = 0.0, .max = 1000.0, .min_open = true},
      "Frame rate; unset: unchanged");
    v("trigger_source", trigger_source, "Trigger of each frame, as Line0; empty: free-running");
    v("socket_buffer_bytes", socket_buffer_bytes, {.min = 65536.0, .max = 1073741824.0},
      "Requested receive buffer; net.core.rmem_max limits it");
    v("packet_size_bytes", packet_size_bytes, {.min = 0.0, .max = 65532.0},
      "Size of stream packets with headers; 0: the largest that interface and camera allow");
    v("packet_delay_ns", packet_delay_ns, {.min = 0.0, .max = 1e9},
      "Pause between packets (GevSCPD, in the camera's ticks); 0: unchanged");
    v("packet_resend", packet_resend, "Request lost packets again");
    v("packet_socket", packet_socket,
      "Read packets from the network card's ring buffer: less load, needs CAP_NET_RAW");
  }
};

/// A recording instead of a camera.
struct ReplayConfig {
  std::filesystem::path folder;
  std::string clock = "real_time";
  double rate = 1.0;
  bool loop = false;
  double stamp_offset_s = 0.0;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("folder", folder,
      "Recording with images, experiment of such, TUM RGB-D folder, or PCD/PLY files with "
      "camera.yaml");
    v("clock", clock, {"real_time", "as_fast_as_possible", "step"},
      "Pace of frames: real_time as recorded; as_fast_as_possible as the queue has room; step "
      "after the last was read");
    v("rate", rate, {.min = 0.001, .max = 1000.0}, "Playback speed, as a multiple of real time");
    v("loop", loop, "Restart at the end, with stamps that continue");
    v("stamp_offset_s", stamp_offset_s, {.min = -1e10, .max = 1e10},
      "Added to the stamps of the files");
  }
};

/// Settings of the frame source.
struct Config {
  std::string source = "genicam";
  GenicamConfig genicam;
  ReplayConfig replay;
  LensConfig depth;
  LensConfig color;
  std::optional<double> depth_unit_m;
  std::optional<double> distance_unit_m;
  std::optional<double> coordinate_scale;
  std::optional<double> baseline_m;
  std::string color_registered = "as_told";
  std::vector<double> color_pose;
  double subpixel_sigma_px = 0.0;
  int queue_frames = 3;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("source", source, {"genicam", "replay", "fake"},
      "GenICam camera, recording, or Aravis' fake camera, which has no depth");
    v("genicam", genicam, "GenICam camera");
    v("replay", replay, "Recording");
    v("depth", depth, "Depth lens");
    v("color", color, "Colour lens");
    v("depth_unit_m", depth_unit_m, {.min = 1e-6, .max = 0.01},
      "Metres in one step of the published depth; unset: the camera's step, else 0.1 mm");
    v("distance_unit_m", distance_unit_m, {.min = 1e-6, .max = 1.0},
      "Metres in one unit of the camera's distances; unset: as the camera reports, else 1 mm");
    v("coordinate_scale", coordinate_scale, {.min = 1e-9, .max = 1e6},
      "Distance units in one step of the camera's z (px of a disparity); unset: as the camera "
      "reports");
    v("baseline_m", baseline_m, {.min = 0.001, .max = 10.0},
      "Baseline of a stereo camera; unset: as the camera reports");
    v("color_registered", color_registered, {"as_told", "yes", "no"},
      "Colour image registered to the depth image; as_told: as the camera reports");
    v("color_pose", color_pose, {.min = -10.0, .max = 10.0},
      "Colour camera in the depth camera's frame: x, y, z in m, unit quaternion x, y, z, w; empty: "
      "as the camera reports, else none");
    v("subpixel_sigma_px", subpixel_sigma_px, {.min = 0.0, .max = 10.0},
      "Disparity noise of a stereo camera, passed on in /camera/setup; 0: unknown");
    v("queue_frames", queue_frames, {.min = 1.0, .max = 64.0},
      "Frames queued for the publisher; a full queue drops the oldest");
  }
};

}  // namespace palpate::capture
