// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/images/joint_frames.hpp"

#include <algorithm>
#include <limits>

#include "libs/core/statistics.hpp"

namespace palpate::experiment {

namespace {

std::int64_t LongestApart_ns(const std::vector<std::vector<std::int64_t>>& t_ns,
                             const JointFramesTuning& tuning) {
  double longest_ns = 1e9 * tuning.longest_apart_s;
  for (const std::vector<std::int64_t>& times : t_ns) {
    std::vector<double> periods_ns;
    for (std::size_t k = 1; k < times.size(); ++k) {
      periods_ns.push_back(static_cast<double>(times[k] - times[k - 1]));
    }
    if (periods_ns.empty()) continue;
    longest_ns = std::min(longest_ns, tuning.share_of_period * Median(periods_ns));
  }
  return static_cast<std::int64_t>(longest_ns);
}

}  // namespace

std::vector<JointFrame> JoinFrames(const std::vector<std::vector<std::int64_t>>& t_ns,
                                   const JointFramesTuning& tuning) {
  const std::int64_t longest_ns = LongestApart_ns(t_ns, tuning);
  std::vector<std::size_t> next(t_ns.size(), 0);
  std::vector<JointFrame> joint;
  for (;;) {
    std::int64_t earliest_ns = std::numeric_limits<std::int64_t>::max();
    bool is_left = false;
    for (std::size_t k = 0; k < t_ns.size(); ++k) {
      if (next[k] == t_ns[k].size()) continue;
      is_left = true;
      earliest_ns = std::min(earliest_ns, t_ns[k][next[k]]);
    }
    if (!is_left) break;
    JointFrame& frame = joint.emplace_back();
    frame.frames.resize(t_ns.size());
    for (std::size_t k = t_ns.size(); k-- > 0;) {
      if (next[k] == t_ns[k].size() || t_ns[k][next[k]] > earliest_ns + longest_ns) continue;
      frame.t_ns = t_ns[k][next[k]];
      frame.frames[k] = next[k]++;
    }
  }
  std::stable_sort(joint.begin(), joint.end(), [](const JointFrame& one, const JointFrame& other) {
    return one.t_ns < other.t_ns;
  });
  return joint;
}

}  // namespace palpate::experiment
