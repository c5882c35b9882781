// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "libs/core/text.hpp"
#include "libs/experiment/captured_markers.hpp"

namespace palpate::experiment {

namespace {

/// A marker at rest in the origin does not move so far from one frame to the next.
constexpr double kShortestJump_m = 0.01;

bool IsAtOrigin(const std::optional<Eigen::Vector3d>& position_m) {
  return position_m && position_m->isZero(0.0);
}

/// [frames] distance from the origin in the nearest frame before or after that sees the marker
/// elsewhere; infinite where none does.
std::vector<double> NearestDistance_m(const std::vector<MarkerFrame>& frames, std::size_t marker) {
  std::vector<double> nearest_m(frames.size(), std::numeric_limits<double>::infinity());
  std::vector<std::size_t> steps(frames.size(), frames.size());
  const auto pass = [&](std::size_t first, std::size_t stride) {
    double last_m = std::numeric_limits<double>::infinity();
    std::size_t since = 0;
    for (std::size_t k = 0, i = first; k < frames.size(); ++k, i += stride) {
      const auto& position_m = frames[i].positions_m[marker];
      ++since;
      if (position_m && !IsAtOrigin(position_m)) {
        last_m = position_m->norm();
        since = 0;
      } else if (last_m < std::numeric_limits<double>::infinity() && since < steps[i]) {
        nearest_m[i] = last_m;
        steps[i] = since;
      }
    }
  };
  pass(0, 1);
  pass(frames.size() - 1, std::size_t{0} - 1);
  return nearest_m;
}

}  // namespace

void TakeOutJumpsToOrigin(CapturedMarkers* captured) {
  std::vector<MarkerFrame>& frames = captured->tracks.frames;
  std::size_t taken = 0;
  std::vector<std::string> names, always;
  for (std::size_t marker = 0; marker < captured->tracks.names.size(); ++marker) {
    const std::vector<double> nearest_m = NearestDistance_m(frames, marker);
    const std::size_t before = taken;
    bool only_origin = true;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      auto& position_m = frames[i].positions_m[marker];
      only_origin = only_origin && IsAtOrigin(position_m);
      const bool jumps =
          nearest_m[i] > kShortestJump_m && nearest_m[i] < std::numeric_limits<double>::infinity();
      if (!IsAtOrigin(position_m) || !jumps) continue;
      position_m.reset();
      if (!captured->residuals_m.empty()) captured->residuals_m[i][marker].reset();
      ++taken;
    }
    if (taken > before) names.push_back(captured->tracks.names[marker]);
    if (only_origin) always.push_back(captured->tracks.names[marker]);
  }
  if (taken > 0) {
    captured->notes.push_back(
        std::to_string(taken) +
        " samples at exactly 0, 0, 0 are taken as not seen: " + Excerpt(Listed(names)));
  }
  if (!always.empty()) {
    captured->notes.push_back("always at 0, 0, 0: " + Excerpt(Listed(always)) +
                              "; if never seen, leave out by --markers");
  }
}

}  // namespace palpate::experiment
