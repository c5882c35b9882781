// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/plot/series_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::view {

namespace {

// A band may reach as far beyond the values as they reach themselves, times this.
constexpr double kBandShare = 0.5;

struct FiniteExtent {
  double lower = std::numeric_limits<double>::infinity();
  double upper = -std::numeric_limits<double>::infinity();

  void Hold(double value) {
    if (!std::isfinite(value)) return;
    lower = std::min(lower, value);
    upper = std::max(upper, value);
  }
};

double HalfWidth(const TimeSeries& series, std::size_t i) {
  return series.half_widths.empty() ? 0.0 : series.half_widths[i];
}

bool IsDrawn(const TimeSeries& series, std::size_t i) {
  return std::isfinite(series.t_s[i]) && std::isfinite(series.values[i]);
}

}  // namespace

AxisRange ValueRange(const PlotPanel& panel) {
  FiniteExtent values;
  FiniteExtent bands;
  for (const TimeSeries& series : panel.series) {
    for (std::size_t i = 0; i < series.values.size(); ++i) {
      values.Hold(series.values[i]);
      bands.Hold(series.values[i] - HalfWidth(series, i));
      bands.Hold(series.values[i] + HalfWidth(series, i));
    }
  }
  if (values.lower > values.upper) return {0.0, 1.0};
  const bool begins_at_zero = panel.from_zero && values.lower >= 0.0;
  const double span = values.upper - (begins_at_zero ? 0.0 : values.lower);
  const double room = kBandShare * (span > 0.0 ? span : std::abs(values.upper));
  const double upper = std::min(std::max(bands.upper, values.upper), values.upper + room);
  if (begins_at_zero) return {0.0, upper > 0.0 ? upper : 1.0};
  return {std::max(std::min(bands.lower, values.lower), values.lower - room), upper};
}

std::vector<std::vector<SvgPoint>> Stretches(const TimeSeries& series, const PlotArea& area) {
  std::vector<std::vector<SvgPoint>> stretches;
  bool inside = false;
  for (std::size_t i = 0; i < series.values.size(); ++i) {
    const bool drawn = IsDrawn(series, i);
    if (drawn && !inside) stretches.emplace_back();
    if (drawn) stretches.back().push_back(area.Place(series.t_s[i], series.values[i]));
    inside = drawn;
  }
  return stretches;
}

std::vector<std::vector<SvgPoint>> BandOutlines(const TimeSeries& series, const PlotArea& area) {
  std::vector<std::vector<SvgPoint>> outlines;
  std::vector<SvgPoint> upper;
  std::vector<SvgPoint> lower;
  const auto close = [&] {
    if (upper.size() >= 2) {
      upper.insert(upper.end(), lower.rbegin(), lower.rend());
      outlines.push_back(upper);
    }
    upper.clear();
    lower.clear();
  };
  for (std::size_t i = 0; i < series.half_widths.size(); ++i) {
    if (!IsDrawn(series, i) || !std::isfinite(series.half_widths[i])) {
      close();
      continue;
    }
    upper.push_back(area.Place(series.t_s[i], series.values[i] + series.half_widths[i]));
    lower.push_back(area.Place(series.t_s[i], series.values[i] - series.half_widths[i]));
  }
  close();
  return outlines;
}

}  // namespace palpate::view
