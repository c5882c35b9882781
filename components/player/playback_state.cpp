// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/player/playback_state.hpp"

#include <cmath>
#include <iomanip>
#include <sstream>

#include "libs/core/text.hpp"

namespace palpate::player {

std::string PlaybackLine(const PlaybackState& state) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << state.position_s << " of " << state.duration_s
       << " s";
  if (state.rate != 1.0) {
    text << ", "
         << (std::isinf(state.rate) ? "as fast as possible" : FormatNumber(state.rate) + "x");
  }
  text << (state.paused ? ", paused, " : ", ") << state.messages << " messages";
  if (state.dropped > 0) text << ", " << state.dropped << " not taken by DDS";
  if (state.ended && std::isfinite(state.lateness_p99_s)) {
    text << std::setprecision(2) << ", late by " << 1e3 * state.lateness_p50_s << " ms (median), "
         << 1e3 * state.lateness_p99_s << " ms (99 %)";
  }
  return text.str();
}

}  // namespace palpate::player
