// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/plot/color.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace palpate::plot {

Color Mix(const Color& a, const Color& b, double t) {
  return {a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t};
}

Color SequentialColor(double t) {
  constexpr std::array<Color, 7> kStops = {FromHex(0x4A4A9C), FromHex(0x3F6AA8), FromHex(0x328CA6),
                                           FromHex(0x35A796), FromHex(0x6CC47A), FromHex(0xB5DA56),
                                           FromHex(0xF8E644)};
  const double position = std::clamp(t, 0.0, 1.0) * static_cast<double>(kStops.size() - 1);
  const auto lower = std::min(static_cast<std::size_t>(position), kStops.size() - 2);
  return Mix(kStops[lower], kStops[lower + 1], position - static_cast<double>(lower));
}

}  // namespace palpate::plot
