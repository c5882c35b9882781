// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/rgbd/ros_formats.hpp"

#include <algorithm>
#include <cmath>

namespace palpate::rgbd {

namespace {

constexpr std::array<ColorLayout, 7> kColorLayouts = {{{"rgb8", 3, {0, 1, 2}},
                                                       {"bgr8", 3, {2, 1, 0}},
                                                       {"8UC3", 3, {2, 1, 0}},
                                                       {"rgba8", 4, {0, 1, 2}},
                                                       {"bgra8", 4, {2, 1, 0}},
                                                       {"mono8", 1, {0, 0, 0}},
                                                       {"8UC1", 1, {0, 0, 0}}}};

}  // namespace

const ColorLayout* ColorLayoutOf(std::string_view encoding) {
  const auto* found =
      std::find_if(kColorLayouts.begin(), kColorLayouts.end(),
                   [&](const ColorLayout& known) { return known.encoding == encoding; });
  return found == kColorLayouts.end() ? nullptr : found;
}

std::optional<Distortion> DistortionOf(std::string_view model, std::span<const double> d) {
  Distortion distortion{};
  if (std::all_of(d.begin(), d.end(), [](double x) { return x == 0.0; })) return distortion;
  const bool plumb_bob = model == "plumb_bob" && (d.size() == 4 || d.size() == 5);
  const bool rational = model == "rational_polynomial" && d.size() == distortion.size();
  if (!plumb_bob && !rational) return std::nullopt;
  std::copy(d.begin(), d.end(), distortion.begin());
  const bool finite = std::all_of(d.begin(), d.end(), [](double x) { return std::isfinite(x); });
  return finite ? std::optional(distortion) : std::nullopt;
}

}  // namespace palpate::rgbd
