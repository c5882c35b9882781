// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/clock/device_clock.hpp"

#include <chrono>
#include <cmath>
#include <limits>

#include "libs/core/clock.hpp"

namespace palpate::capture {

namespace {

constexpr int kFirstSamples = 8;
constexpr auto kSamplePeriod = std::chrono::seconds(1);

std::optional<std::int64_t> TickFrequency_Hz(Features& features) {
  for (const char* name : {"GevTimestampTickFrequency", "ArvGevTimestampTickFrequency"}) {
    const auto frequency = features.Integer(name);
    if (frequency && *frequency > 0 && *frequency <= 100'000'000'000) return frequency;
  }
  return std::nullopt;
}

}  // namespace

std::optional<ClockSample> LatchClock(Features& features) {
  const bool standard = features.Has("TimestampLatch") && features.Has("TimestampLatchValue");
  const char* command = standard ? "TimestampLatch" : "GevTimestampControlLatch";
  const char* value = standard ? "TimestampLatchValue" : "GevTimestampValue";
  if (!standard && (!features.Has(command) || !features.Has(value))) return std::nullopt;
  ClockSample sample;
  sample.host_before_ns = WallNow_ns();
  if (!features.Execute(command).ok()) return std::nullopt;
  sample.host_after_ns = WallNow_ns();
  const auto ticks = features.Integer(value);
  if (!ticks || *ticks <= 0) return std::nullopt;
  sample.device_ns = *ticks;
  if (standard) return sample;
  const auto frequency_Hz = TickFrequency_Hz(features);
  if (!frequency_Hz) return std::nullopt;
  const auto device_ns =
      static_cast<long double>(*ticks) * 1e9L / static_cast<long double>(*frequency_Hz);
  if (!(device_ns < 9e18L)) return std::nullopt;
  sample.device_ns = static_cast<std::int64_t>(device_ns);
  return sample;
}

bool PtpRuns(Features& features) {
  for (const char* name : {"PtpStatus", "GevIEEE1588Status"}) {
    const auto status = features.Text(name);
    if (status) return *status == "Slave" || *status == "Master";
  }
  return false;
}

DeviceClock::DeviceClock(Features& features)
    : features_(features), temperature_degC_(std::numeric_limits<double>::quiet_NaN()) {
  for (int i = 0; i < kFirstSamples; ++i) Sample();
  thread_ = std::thread([this] { Run(); });
}

DeviceClock::~DeviceClock() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  stopping_.notify_all();
  thread_.join();
}

void DeviceClock::Sample() {
  const auto sample = LatchClock(features_);
  const bool ptp = PtpRuns(features_);
  const std::lock_guard lock(mutex_);
  if (sample) fit_.Add(*sample);
  fit_.SetPtp(ptp);
}

void DeviceClock::Run() {
  std::unique_lock lock(mutex_);
  while (!stopping_.wait_for(lock, kSamplePeriod, [this] { return stop_; })) {
    lock.unlock();
    Sample();
    const auto temperature = features_.Number("DeviceTemperature");
    lock.lock();
    if (temperature && std::isfinite(*temperature)) temperature_degC_ = *temperature;
  }
}

std::optional<std::int64_t> DeviceClock::ToHost_ns(std::int64_t device_ns) const {
  const std::lock_guard lock(mutex_);
  return fit_.ToHost_ns(device_ns);
}

ClockSource DeviceClock::source() const {
  const std::lock_guard lock(mutex_);
  return fit_.source();
}

double DeviceClock::temperature_degC() const {
  const std::lock_guard lock(mutex_);
  return temperature_degC_;
}

}  // namespace palpate::capture
