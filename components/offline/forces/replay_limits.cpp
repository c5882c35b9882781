// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/forces/replay_limits.hpp"

#include <cmath>

namespace palpate::offline {

std::vector<bool> KeptFrames(const std::vector<double>& t_s, double rate_Hz) {
  if (!(rate_Hz > 0.0)) return std::vector<bool>(t_s.size(), true);
  constexpr double kSameTime = 1e-3;  // of a period: stamps are rounded
  std::vector<bool> kept;
  double last_period = -1.0;
  for (const double time_s : t_s) {
    const double period = std::floor((time_s - t_s.front()) * rate_Hz + kSameTime);
    kept.push_back(period > last_period);
    if (kept.back()) last_period = period;
  }
  return kept;
}

}  // namespace palpate::offline
