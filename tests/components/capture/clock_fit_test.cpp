// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/clock/clock_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "components/capture/clock/device_clock.hpp"
#include "libs/core/clock.hpp"
#include "tests/components/capture/map_features.hpp"

namespace palpate::capture {
namespace {

constexpr std::int64_t kStart_ns = 1'790'000'000'000'000'000;
constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// A device's quartz that is off, asked over a way that is sometimes slow in one direction.
class Device {
 public:
  explicit Device(double drift) : drift_(drift) {}

  std::int64_t DeviceAt(std::int64_t host_ns) const {
    const double since = static_cast<double>(host_ns - kStart_ns);
    return 5'000'000'000 + std::llround(since * (1.0 + drift_));
  }
  ClockSample Sample(std::int64_t host_ns, std::mt19937& random) const {
    std::exponential_distribution<double> jitter_ns(1.0 / 50e3);
    const auto there = static_cast<std::int64_t>(60e3 + jitter_ns(random));
    const auto back = static_cast<std::int64_t>(60e3 + jitter_ns(random));
    return {DeviceAt(host_ns + there), host_ns, host_ns + there + back};
  }

 private:
  double drift_;
};

TEST(ClockFit, FollowsADriftingClockThroughJitterToTenMicroseconds) {
  constexpr unsigned kSeed = 4;
  for (const double drift : {0.0, 50e-6, -80e-6}) {
    std::mt19937 random(kSeed);
    const Device device(drift);
    ClockFit fit;
    double worst_ns = 0.0;
    for (int second = 0; second < 300; ++second) {
      const std::int64_t now_ns = kStart_ns + second * kSecond_ns;
      fit.Add(device.Sample(now_ns, random));
      if (second < 20) continue;
      for (int i = 0; i < 30; ++i) {
        const std::int64_t host_ns = now_ns + i * kSecond_ns / 30;
        const auto mapped = fit.ToHost_ns(device.DeviceAt(host_ns));
        worst_ns = std::max(worst_ns, std::abs(static_cast<double>(*mapped - host_ns)));
      }
    }
    EXPECT_LT(worst_ns, 10e3) << "drift " << drift << ", seed " << kSeed;
  }
}

TEST(ClockFit, IsUsableFromTheFirstSampleOn) {
  ClockFit fit;
  EXPECT_FALSE(fit.ToHost_ns(1).has_value());
  EXPECT_EQ(fit.source(), ClockSource::kHostReceive);
  fit.Add({100, 5000, 5100});
  EXPECT_EQ(fit.ToHost_ns(100), 5050);
  EXPECT_EQ(fit.ToHost_ns(300), 5250);
  EXPECT_EQ(fit.source(), ClockSource::kDeviceMapped);
}

TEST(ClockFit, BeginsAnewWhereAClockWasSet) {
  std::mt19937 random(7);
  const Device device(20e-6);
  ClockFit fit;
  for (int i = 0; i < 30; ++i) fit.Add(device.Sample(kStart_ns + i * kSecond_ns, random));
  ClockSample later = device.Sample(kStart_ns + 31 * kSecond_ns, random);
  later.host_before_ns += 3600 * kSecond_ns;
  later.host_after_ns += 3600 * kSecond_ns;
  fit.Add(later);
  const std::int64_t middle_ns = (later.host_before_ns + later.host_after_ns) / 2;
  EXPECT_LT(std::abs(*fit.ToHost_ns(later.device_ns) - middle_ns), 1000);
  ClockSample reset = {1000, kStart_ns + 40 * kSecond_ns, kStart_ns + 40 * kSecond_ns + 1000};
  fit.Add(reset);  // the camera was switched off and on
  EXPECT_LT(std::abs(*fit.ToHost_ns(1000) - reset.host_before_ns - 500), 1000);
}

TEST(ClockFit, PtpTimeIsTakenAsItIsWhereItFitsTheHosts) {
  for (const std::int64_t ahead_ns : {kTaiMinusUtc_ns, std::int64_t{0}}) {
    ClockFit fit;
    fit.SetPtp(true);
    fit.Add({kStart_ns + ahead_ns + 300'000, kStart_ns, kStart_ns + 100'000});
    EXPECT_EQ(fit.source(), ClockSource::kPtp);
    EXPECT_EQ(fit.ToHost_ns(kStart_ns + ahead_ns), kStart_ns);
  }
  ClockFit wrong;
  wrong.SetPtp(true);
  wrong.Add({kStart_ns + 5 * kSecond_ns, kStart_ns, kStart_ns + 100});
  EXPECT_EQ(wrong.source(), ClockSource::kDeviceMapped);
}

TEST(ClockFit, AnAbsurdRateIsNotFollowed) {
  ClockFit fit;
  for (int i = 0; i < 10; ++i) {  // runs 1 % fast: no quartz does; each step is under the jump
    const std::int64_t host_ns = kStart_ns + i * kSecond_ns;
    fit.Add({1000 + i * (kSecond_ns + 10'000'000), host_ns, host_ns + 1000});
  }
  const auto a = fit.ToHost_ns(1000), b = fit.ToHost_ns(1000 + kSecond_ns);
  EXPECT_EQ(*b - *a, kSecond_ns);
}

TEST(DeviceClock, BothGenerationsOfNamesAreKnown) {
  MapFeatures standard;
  standard.values["TimestampLatch"] = true;
  standard.values["TimestampLatchValue"] = std::int64_t{123456789};
  const auto sample = LatchClock(standard);
  ASSERT_TRUE(sample.has_value());
  EXPECT_EQ(sample->device_ns, 123456789);
  EXPECT_LE(sample->host_before_ns, sample->host_after_ns);
  EXPECT_EQ(standard.executed, std::vector<std::string>{"TimestampLatch"});

  MapFeatures older;
  older.values["GevTimestampControlLatch"] = true;
  older.values["GevTimestampValue"] = std::int64_t{125'000'000};
  EXPECT_FALSE(LatchClock(older).has_value());  // ticks of unknown length
  older.values["GevTimestampTickFrequency"] = std::int64_t{125'000'000};
  EXPECT_EQ(LatchClock(older)->device_ns, kSecond_ns);
  older.values["GevTimestampTickFrequency"] = std::int64_t{0};
  EXPECT_FALSE(LatchClock(older).has_value());

  MapFeatures none;
  EXPECT_FALSE(LatchClock(none).has_value());
}

TEST(DeviceClock, WithoutAClockStampsAreThoseOfReception) {
  MapFeatures none;
  const DeviceClock clock(none);
  EXPECT_EQ(clock.source(), ClockSource::kHostReceive);
  EXPECT_FALSE(clock.ToHost_ns(1).has_value());
  EXPECT_TRUE(std::isnan(clock.temperature_degC()));
}

TEST(DeviceClock, PtpIsOnWhereTheDeviceFollowsOrLeads) {
  MapFeatures f;
  EXPECT_FALSE(PtpRuns(f));
  for (const auto& [status, runs] : std::vector<std::pair<std::string, bool>>{
           {"Slave", true}, {"Master", true}, {"Disabled", false}, {"Listening", false}}) {
    f.values["PtpStatus"] = status;
    EXPECT_EQ(PtpRuns(f), runs) << status;
  }
}

}  // namespace
}  // namespace palpate::capture
