// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/estimate/replay_limits.hpp"

#include <fmt/core.h>

#include <cmath>

namespace palpate::command {

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

std::string AdviceWhereSlow(const robot::RobotBody& body) {
  std::string advice =
      fmt::format("palpate estimate: slow with a mesh of {} nodes: --rate HZ leaves frames out",
                  body.mesh.NodeCount());
  if (body.mesh.element_type() == fem::ElementType::kTet10) {
    advice += "; element: tet4 is faster and stiffer (calibrate it again)";
  }
  return advice;
}

}  // namespace palpate::command
