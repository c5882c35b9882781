// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

namespace palpate {

/// Four times of one message there and one back, ns. Sent and answered_at are of the own clock, the
/// other two of the other host's (RFC 5905, section 8: T1 to T4).
struct ClockExchange {
  std::int64_t sent_ns = 0;         ///< own message left
  std::int64_t received_ns = 0;     ///< it came to the other host
  std::int64_t returned_ns = 0;     ///< the other host's next message left
  std::int64_t returned_to_ns = 0;  ///< it came back
};

/// Another host's clock minus the own one.
struct ClockOffset {
  double offset_s = 0.0;
  /// Half the time under way of the fastest exchange, which bounds the error whatever share of it
  /// either direction took; grows by 50 ppm of the exchange's age.
  double bound_s = 0.0;
};

/// Offset of one other clock from exchanges. The one that was the shortest time under way has the
/// tightest bound and decides (RFC 5905's clock filter).
class ClockOffsetFilter {
 public:
  /// False: the times contradict each other (a clock was set in between), nothing was taken.
  /// An exchange whose bounds exclude those of the earlier ones means that a clock was set: they
  /// are dropped.
  bool Add(const ClockExchange& exchange);

  /// nullopt before the first exchange. `now_ns`: by the own clock.
  std::optional<ClockOffset> At(std::int64_t now_ns) const;

 private:
  struct Sample {
    std::int64_t time_ns = 0;  ///< own clock
    double offset_s = 0.0;
    double half_delay_s = 0.0;
  };

  static ClockOffset Aged(const Sample& sample, std::int64_t now_ns);

  static constexpr std::size_t kMostSamples = 16;

  std::deque<Sample> samples_;
};

}  // namespace palpate
