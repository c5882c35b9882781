// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/clock/clock_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace palpate::capture {

namespace {

constexpr std::int64_t kWindow_ns = 60'000'000'000;
constexpr std::int64_t kGreatestJump_ns = 20'000'000;
constexpr double kLeastSpanForRate_ns = 4e9;
constexpr double kGreatestRate = 1e-3;  ///< 1000 ppm: no quartz is so far off
constexpr std::size_t kMostSamples = 256;
constexpr double kSymmetricError_ns = 3000.0;

std::int64_t RoundTrip_ns(const ClockSample& s) { return s.host_after_ns - s.host_before_ns; }
std::int64_t Middle_ns(const ClockSample& s) { return s.host_before_ns + RoundTrip_ns(s) / 2; }

}  // namespace

void ClockFit::Add(const ClockSample& sample) {
  if (RoundTrip_ns(sample) < 0) return;  // the host's clock was set in between
  const auto expected_ns = ToHost_ns(sample.device_ns);
  const bool jumped = expected_ns && std::abs(*expected_ns - Middle_ns(sample)) >
                                         kGreatestJump_ns + RoundTrip_ns(sample);
  const bool went_back = !samples_.empty() && sample.device_ns <= samples_.back().device_ns;
  if (jumped || went_back) samples_.clear();
  samples_.push_back(sample);
  while (samples_.size() > kMostSamples ||
         sample.device_ns - samples_.front().device_ns > kWindow_ns) {
    samples_.pop_front();
  }
  Fit();
}

void ClockFit::Fit() {
  const auto shortest = std::min_element(
      samples_.begin(), samples_.end(),
      [](const ClockSample& a, const ClockSample& b) { return RoundTrip_ns(a) < RoundTrip_ns(b); });
  device_origin_ns_ = shortest->device_ns;
  host_origin_ns_ = Middle_ns(*shortest);
  // The shortest trip is taken for symmetric; what another took longer may all have been on one of
  // its two ways: its middle is off by half of that.
  const double least_ns = static_cast<double>(RoundTrip_ns(*shortest));
  double weights = 0.0, sum_x = 0.0, sum_y = 0.0, sum_xx = 0.0, sum_xy = 0.0;
  double first_x = 0.0, last_x = 0.0;
  for (const ClockSample& sample : samples_) {
    const double longer_ns = static_cast<double>(RoundTrip_ns(sample)) - least_ns;
    const double weight = 1.0 / std::pow(longer_ns + kSymmetricError_ns, 2);
    const double x = static_cast<double>(sample.device_ns - device_origin_ns_);
    const double y = static_cast<double>(Middle_ns(sample) - host_origin_ns_) - x;
    weights += weight;
    sum_x += weight * x;
    sum_y += weight * y;
    sum_xx += weight * x * x;
    sum_xy += weight * x * y;
    first_x = std::min(first_x, x);
    last_x = std::max(last_x, x);
  }
  const double spread = sum_xx - sum_x * sum_x / weights;
  rate_ = last_x - first_x >= kLeastSpanForRate_ns && spread > 0.0
              ? (sum_xy - sum_x * sum_y / weights) / spread
              : 0.0;
  if (std::abs(rate_) > kGreatestRate) rate_ = 0.0;
  offset_ns_ = (sum_y - rate_ * sum_x) / weights;
}

std::optional<std::int64_t> ClockFit::PtpOffset_ns() const {
  if (!ptp_ || samples_.empty()) return std::nullopt;
  const std::int64_t ahead_ns = samples_.back().device_ns - Middle_ns(samples_.back());
  for (const std::int64_t offset_ns : {kTaiMinusUtc_ns, std::int64_t{0}}) {
    if (std::abs(ahead_ns - offset_ns) < kGreatestJump_ns) return offset_ns;
  }
  return std::nullopt;
}

ClockSource ClockFit::source() const {
  if (samples_.empty()) return ClockSource::kHostReceive;
  return PtpOffset_ns() ? ClockSource::kPtp : ClockSource::kDeviceMapped;
}

std::optional<std::int64_t> ClockFit::ToHost_ns(std::int64_t device_ns) const {
  if (samples_.empty()) return std::nullopt;
  if (const auto offset_ns = PtpOffset_ns()) return device_ns - *offset_ns;
  const std::int64_t since_ns = device_ns - device_origin_ns_;
  const double correction_ns = offset_ns_ + rate_ * static_cast<double>(since_ns);
  return host_origin_ns_ + since_ns + std::llround(correction_ns);
}

}  // namespace palpate::capture
