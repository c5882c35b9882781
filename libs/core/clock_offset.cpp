// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/clock_offset.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/seconds.hpp"

namespace palpate {

namespace {

/// Largest rate error between two crystal clocks that NTP does not correct.
constexpr double kDrift = 50e-6;

}  // namespace

ClockOffset ClockOffsetFilter::Aged(const Sample& sample, std::int64_t now_ns) {
  const double age_s = std::abs(NsToSeconds(now_ns - sample.time_ns));
  return {sample.offset_s, sample.half_delay_s + kDrift * age_s};
}

bool ClockOffsetFilter::Add(const ClockExchange& exchange) {
  const std::int64_t away_ns = exchange.returned_to_ns - exchange.sent_ns;
  const std::int64_t there_ns = exchange.returned_ns - exchange.received_ns;
  if (there_ns < 0 || away_ns < there_ns) return false;
  Sample sample{.time_ns = exchange.returned_to_ns,
                .offset_s = 0.5 * (NsToSeconds(exchange.received_ns - exchange.sent_ns) +
                                   NsToSeconds(exchange.returned_ns - exchange.returned_to_ns)),
                .half_delay_s = 0.5 * NsToSeconds(away_ns - there_ns)};
  if (const auto known = At(sample.time_ns)) {
    const bool agrees =
        std::abs(sample.offset_s - known->offset_s) <= sample.half_delay_s + known->bound_s;
    if (!agrees) samples_.clear();
  }
  if (samples_.size() == kMostSamples) samples_.pop_front();
  samples_.push_back(sample);
  return true;
}

std::optional<ClockOffset> ClockOffsetFilter::At(std::int64_t now_ns) const {
  if (samples_.empty()) return std::nullopt;
  ClockOffset best = Aged(samples_.front(), now_ns);
  for (const Sample& sample : samples_) {
    const ClockOffset other = Aged(sample, now_ns);
    if (other.bound_s <= best.bound_s) best = other;
  }
  return best;
}

}  // namespace palpate
