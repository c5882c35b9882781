// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/player/playback_clock.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate::player {

PlaybackClock::PlaybackClock(double rate, Clock now)
    : rate_(rate), now_(std::move(now)), real_ns_(now_()) {}

void PlaybackClock::Set(std::int64_t recording_ns) {
  recording_ns_ = recording_ns;
  real_ns_ = now_();
}

void PlaybackClock::Pause() {
  Set(Now_ns());
  paused_ = true;
}

void PlaybackClock::Resume() {
  Set(Now_ns());
  paused_ = false;
}

void PlaybackClock::SetRate(double rate) {
  Set(Now_ns());
  rate_ = rate;
}

std::int64_t PlaybackClock::Now_ns() const {
  if (paused_ || std::isinf(rate_)) return recording_ns_;
  return recording_ns_ + std::llround(rate_ * static_cast<double>(now_() - real_ns_));
}

std::optional<std::int64_t> PlaybackClock::Until_ns(std::int64_t recording_ns) const {
  if (paused_) return std::nullopt;
  if (std::isinf(rate_)) return 0;
  const double due_ns = static_cast<double>(recording_ns - recording_ns_) / rate_;
  return std::max<std::int64_t>(0, real_ns_ + std::llround(due_ns) - now_());
}

}  // namespace palpate::player
