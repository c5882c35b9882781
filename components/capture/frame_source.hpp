// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "libs/rgbd/rgbd_camera.hpp"
#include "libs/rgbd/rgbd_frame.hpp"

namespace palpate::capture {

/// Where the host stamp of a frame comes from.
enum class ClockSource { kHostReceive, kDeviceMapped, kPtp, kReplay };

/// What is known about one frame besides its pixels; NaN and nullopt: not reported by the camera.
struct FrameFacts {
  std::uint64_t frame_id = 0;  ///< the camera's
  std::uint32_t epoch = 0;     ///< rises whenever the camera was reopened
  std::int64_t stamp_device_ns = 0;
  std::int64_t stamp_host_ns = 0;     ///< device stamp on the host's clock (UTC)
  std::int64_t stamp_receive_ns = 0;  ///< when the last packet was there
  ClockSource clock_source = ClockSource::kHostReceive;
  std::int64_t pairing_difference_ns = 0;  ///< colour minus depth, of two paired devices
  double exposure_s = std::numeric_limits<double>::quiet_NaN();
  double gain_dB = std::numeric_limits<double>::quiet_NaN();
  double temperature_degC = std::numeric_limits<double>::quiet_NaN();
  double valid_ratio = 0.0;        ///< share of depth pixels with a value
  std::uint64_t packets_lost = 0;  ///< of this frame, after resend
  std::uint64_t packets_resent = 0;
};

/// One frame set in a pooled buffer: goes back to the pool when the last holder releases it.
struct SourceFrame {
  rgbd::RgbdFrame images;
  FrameFacts facts;
  std::shared_ptr<const rgbd::RgbdCamera> camera;  ///< that it was taken with
};
using FramePtr = std::shared_ptr<const SourceFrame>;

enum class SourceState { kDiscover, kOpen, kConfigure, kStream, kStale, kLost, kEnded };

/// State of the source; all counters since the start.
struct SourceHealth {
  SourceState state = SourceState::kDiscover;
  std::string reason;        ///< for a person; empty while all is well
  std::string last_failure;  ///< why the last of `frames_failed` was not used
  std::string device;        ///< "vendor-serial", folder
  std::string model;
  std::uint32_t epoch = 0;
  std::uint64_t frames = 0;
  std::uint64_t frames_failed = 0;   ///< incomplete, undecodable
  std::uint64_t frames_dropped = 0;  ///< the reader was slower than the camera
  std::uint64_t packets_resent = 0;
  std::uint64_t packets_lost = 0;
  std::uint64_t socket_drops = 0;  ///< by the kernel (/proc/net/udp)
  std::vector<std::string> notes;  ///< what was assumed or should be mended, for a person
};

/// A camera, or what stands in for one. Frames come in threads of the source's own.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  /// The oldest frame that waits, or nothing when none came for `timeout_s`. Where the reader is
  /// slow, the oldest are dropped and counted. Never throws once the source is made.
  virtual FramePtr Next(double timeout_s) = 0;
  virtual SourceHealth Health() const = 0;
};

}  // namespace palpate::capture
