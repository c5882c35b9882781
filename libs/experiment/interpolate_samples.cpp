// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/interpolate_samples.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "libs/core/check.hpp"

namespace palpate::experiment {

double InterpolateSamples(const std::vector<double>& t_s,
                          const std::vector<std::optional<double>>& samples, double now_s) {
  PALPATE_CHECK(samples.size() == t_s.size(), samples.size(), t_s.size());
  const auto upper = std::upper_bound(t_s.begin(), t_s.end(), now_s);
  const auto split = static_cast<std::size_t>(upper - t_s.begin());
  std::size_t before = split;
  while (before > 0 && !samples[before - 1]) --before;
  std::size_t after = split;
  while (after < t_s.size() && !samples[after]) ++after;
  PALPATE_CHECK(before > 0 || after < t_s.size(), before, after);
  if (before == 0) return *samples[after];
  if (after == t_s.size()) return *samples[before - 1];
  const double fraction = (now_s - t_s[before - 1]) / (t_s[after] - t_s[before - 1]);
  return std::lerp(*samples[before - 1], *samples[after], fraction);
}

}  // namespace palpate::experiment
