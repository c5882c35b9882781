// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <thread>

#include "components/capture/clock/clock_fit.hpp"
#include "components/capture/genicam/features.hpp"

namespace palpate::capture {

/// The device's clock now, latched by its command of either generation of names, ns. The host's
/// clock is read just before and after the command. Nothing where the device has no such command.
std::optional<ClockSample> LatchClock(Features& features);

/// True where the device follows or leads a PTP clock.
bool PtpRuns(Features& features);

/// Samples a device's clock and temperature once a second in a thread of its own, because a device
/// that is gone makes each question last seconds. Uses `features` alone from construction to
/// destruction.
class DeviceClock {
 public:
  explicit DeviceClock(Features& features);
  ~DeviceClock();
  DeviceClock(const DeviceClock&) = delete;
  DeviceClock& operator=(const DeviceClock&) = delete;

  std::optional<std::int64_t> ToHost_ns(std::int64_t device_ns) const;
  ClockSource source() const;
  double temperature_degC() const;  ///< NaN: not reported

 private:
  void Run();
  void Sample();

  Features& features_;
  mutable std::mutex mutex_;
  std::condition_variable stopping_;
  bool stop_ = false;
  ClockFit fit_;
  double temperature_degC_;
  std::thread thread_;
};

}  // namespace palpate::capture
