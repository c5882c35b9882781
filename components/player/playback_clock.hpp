// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <optional>

#include "libs/core/clock.hpp"

namespace palpate::player {

/// The time of a recording while it is played: runs at a rate, stands, and jumps. Its real time is
/// an argument, so that tests can turn it by hand.
class PlaybackClock {
 public:
  /// `rate` > 0: 1 is real time, infinity as fast as possible. `now`: any clock that never jumps.
  PlaybackClock(double rate, Clock now);

  /// It is `recording_ns` now.
  void Set(std::int64_t recording_ns);
  void Pause();
  void Resume();
  /// `rate` > 0.
  void SetRate(double rate);

  bool paused() const { return paused_; }
  double rate() const { return rate_; }
  /// Of the recording, ns. At infinite rate the time that was set last.
  std::int64_t Now_ns() const;
  /// Real time until `recording_ns`, ns; 0 where it has passed; nullopt while time stands.
  std::optional<std::int64_t> Until_ns(std::int64_t recording_ns) const;

 private:
  double rate_;
  Clock now_;
  bool paused_ = false;
  std::int64_t recording_ns_ = 0;  ///< was the time of the recording
  std::int64_t real_ns_ = 0;       ///< at this real time
};

}  // namespace palpate::player
