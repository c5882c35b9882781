// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/plot/axis_ticks.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "libs/core/check.hpp"
#include "libs/core/error.hpp"

namespace palpate::plot {

namespace {

// Marks that lie on the range's ends count, whatever the rounding.
constexpr double kSlack = 1e-9;

// The nearest of 1, 2 and 5 times a power of ten to a `count`-th of the range.
double TickStep(const AxisRange& range, int count) {
  const double raw = (range.upper - range.lower) / std::max(count, 2);
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (raw <= 1.4 * factor * power) return factor * power;
  }
  return 10.0 * power;
}

int DecimalsOf(double step) {
  return std::clamp(static_cast<int>(-std::floor(std::log10(step) + kSlack)), 0, 12);
}

}  // namespace

AxisTicks MakeTicks(const AxisRange& range, int count) {
  if (!std::isfinite(range.lower) || !std::isfinite(range.upper) || !(range.lower < range.upper)) {
    throw RunError("an axis from " + FixedText(range.lower, 6) + " to " +
                   FixedText(range.upper, 6) + " cannot be drawn");
  }
  const double step = TickStep(range, count);
  const double first = std::ceil(range.lower / step - kSlack);
  const double last = std::floor(range.upper / step + kSlack);
  if (last < first + 1.0) return MakeTicks(range, 2 * std::max(count, 2));
  AxisTicks ticks;
  for (double k = first; k <= last; ++k) {
    ticks.values.push_back(k * step);
    ticks.labels.push_back(FixedText(k * step, DecimalsOf(step)));
  }
  return ticks;
}

AxisRange RoundOutward(const AxisRange& range, int count) {
  if (!(range.lower < range.upper)) {
    const double half = range.lower == 0.0 ? 1.0 : 0.5 * std::abs(range.lower);
    return RoundOutward({range.lower - half, range.lower + half}, count);
  }
  const double step = TickStep(range, count);
  return {std::floor(range.lower / step + kSlack) * step,
          std::ceil(range.upper / step - kSlack) * step};
}

std::string FixedText(double value, int decimals) {
  if (!std::isfinite(value)) return std::isnan(value) ? "nan" : value > 0.0 ? "inf" : "-inf";
  std::array<char, 512> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value,
                                 std::chars_format::fixed, decimals);
  PALPATE_CHECK(end.ec == std::errc(), value, decimals);
  const std::string result(text.data(), end.ptr);
  const bool is_zero = result.find_first_not_of("-0.") == std::string::npos;
  return is_zero && result.front() == '-' ? result.substr(1) : result;
}

}  // namespace palpate::plot
