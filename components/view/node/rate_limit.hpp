// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>

#include "libs/core/seconds.hpp"

namespace palpate::view {

/// Lets through at most so many per second.
class RateLimit {
 public:
  /// `rate_hz` 0: none.
  explicit RateLimit(double rate_hz) : rate_hz_(rate_hz) {}

  bool Pass(std::int64_t now_ns) {
    if (rate_hz_ <= 0.0) return false;
    // A tenth early, so that a stream of this very rate is not halved by its jitter.
    constexpr double kEarly = 0.9;
    if (has_passed_ && now_ns >= last_ns_ && NsToSeconds(now_ns - last_ns_) < kEarly / rate_hz_) {
      return false;
    }
    has_passed_ = true;
    last_ns_ = now_ns;
    return true;
  }

 private:
  double rate_hz_;
  bool has_passed_ = false;
  std::int64_t last_ns_ = 0;
};

}  // namespace palpate::view
