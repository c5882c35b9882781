// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>

namespace palpate::player {

/// How far a recording is played.
struct PlaybackState {
  double position_s = 0.0;  ///< from its beginning
  double duration_s = 0.0;
  double rate = 1.0;
  bool paused = false;
  bool ended = false;
  std::uint64_t messages = 0;  ///< sent
  std::uint64_t dropped = 0;   ///< that DDS did not take
  /// How much later than due messages went to DDS, s; NaN: none was due at a time.
  double lateness_p50_s = 0.0;
  double lateness_p99_s = 0.0;
};

/// "12.3 of 60.0 s, 2x, paused, 1234 messages".
std::string PlaybackLine(const PlaybackState& state);

}  // namespace palpate::player
