// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "components/capture/frame_source.hpp"

namespace palpate::capture {

/// One reading of the device's clock: latched at some time between the two host times.
struct ClockSample {
  std::int64_t device_ns = 0;
  std::int64_t host_before_ns = 0;  ///< UTC
  std::int64_t host_after_ns = 0;
};

/// TAI - UTC since 2017: what a device on PTP time is ahead of the host's clock.
inline constexpr std::int64_t kTaiMinusUtc_ns = 37'000'000'000;

/// Maps the device's clock to the host's: a line through the samples of the last minute whose round
/// trip was short. Reached on loopback: +-6 us. Not thread-safe.
class ClockFit {
 public:
  /// A sample that is off the line by more than 20 ms means that a clock was set: restarts.
  void Add(const ClockSample& sample);
  /// PTP is on at the device: its time is TAI (or UTC), taken as it is where the samples agree to
  /// 20 ms.
  void SetPtp(bool on) { ptp_ = on; }

  bool ready() const { return !samples_.empty(); }
  /// kDeviceMapped or kPtp; kHostReceive before the first sample.
  ClockSource source() const;
  /// UTC of a device stamp; nothing before the first sample.
  std::optional<std::int64_t> ToHost_ns(std::int64_t device_ns) const;

 private:
  void Fit();
  std::optional<std::int64_t> PtpOffset_ns() const;

  std::deque<ClockSample> samples_;
  bool ptp_ = false;
  std::int64_t device_origin_ns_ = 0;
  std::int64_t host_origin_ns_ = 0;
  double rate_ = 0.0;       ///< host ns for each device ns, less 1
  double offset_ns_ = 0.0;  ///< at the origin
};

}  // namespace palpate::capture
