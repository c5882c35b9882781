// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/player/pacer.hpp"

#include <algorithm>

namespace palpate::player {

Pacer::Duration Pacer::TimeUntil(const std::string& recording, double t_s) {
  const Duration now = clock_();
  if (!started_ || recording != recording_ || t_s < last_t_s_) {
    started_ = true;
    recording_ = recording;
    first_t_s_ = t_s;
    start_ = now;
  }
  last_t_s_ = t_s;
  const std::chrono::duration<double> played((t_s - first_t_s_) / rate_);
  const Duration due = start_ + std::chrono::duration_cast<Duration>(played);
  return std::max(Duration::zero(), due - now);
}

}  // namespace palpate::player
