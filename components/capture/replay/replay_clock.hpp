// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>

namespace palpate::capture {

/// When the frames of a recording are due, in real time. No clock of its own: each call says what
/// time it is (monotonic, ns).
class ReplayClock {
 public:
  /// `rate`: so many times real time.
  explicit ReplayClock(double rate) : rate_(rate) {}

  /// The first frame is due at once.
  void Restart(std::int64_t now_ns, std::int64_t first_stamp_ns) {
    start_ns_ = now_ns;
    first_stamp_ns_ = first_stamp_ns;
  }
  std::int64_t DueAt_ns(std::int64_t stamp_ns) const {
    return start_ns_ +
           static_cast<std::int64_t>(static_cast<double>(stamp_ns - first_stamp_ns_) / rate_);
  }

 private:
  double rate_;
  std::int64_t start_ns_ = 0;
  std::int64_t first_stamp_ns_ = 0;
};

}  // namespace palpate::capture
