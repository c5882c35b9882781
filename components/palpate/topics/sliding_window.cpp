// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/topics/sliding_window.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace palpate::command {

namespace {

std::string Spread(const WindowStatistics& statistics) {
  return fmt::format("\tmin: {:.3f}s max: {:.3f}s std dev: {:.5f}s window: {}\n", statistics.min,
                     statistics.max, statistics.standard_deviation, statistics.count);
}

/// In the unit that a rate of `bytes_per_s` is told in.
std::string Bytes(double bytes, double bytes_per_s) {
  if (bytes_per_s < 1e3) return fmt::format("{:.0f} B", bytes);
  if (bytes_per_s < 1e6) return fmt::format("{:.2f} KB", 1e-3 * bytes);
  return fmt::format("{:.2f} MB", 1e-6 * bytes);
}

}  // namespace

void SlidingWindow::Add(double value) {
  values_.push_back(value);
  if (values_.size() > size_) values_.pop_front();
}

WindowStatistics SlidingWindow::Statistics() const {
  WindowStatistics statistics;
  if (values_.empty()) return statistics;
  const auto [min, max] = std::minmax_element(values_.begin(), values_.end());
  const double count = static_cast<double>(values_.size());
  double sum = 0.0;
  for (const double value : values_) sum += value;
  statistics.mean = sum / count;
  double squares = 0.0;
  for (const double value : values_)
    squares += (value - statistics.mean) * (value - statistics.mean);
  statistics.standard_deviation = std::sqrt(squares / count);
  statistics.min = *min;
  statistics.max = *max;
  statistics.count = values_.size();
  return statistics;
}

std::string RateLines(const WindowStatistics& intervals_s) {
  const double rate_hz = intervals_s.mean > 0.0 ? 1.0 / intervals_s.mean : 0.0;
  return fmt::format("average rate: {:.3f}\n", rate_hz) + Spread(intervals_s);
}

std::string DelayLines(const WindowStatistics& ages_s) {
  return fmt::format("average delay: {:.3f}\n", ages_s.mean) + Spread(ages_s);
}

std::string BandwidthLines(double bytes_per_s, const WindowStatistics& sizes) {
  return fmt::format("{}/s from {} messages\n\tMessage size mean: {} min: {} max: {}\n",
                     Bytes(bytes_per_s, bytes_per_s), sizes.count, Bytes(sizes.mean, bytes_per_s),
                     Bytes(sizes.min, bytes_per_s), Bytes(sizes.max, bytes_per_s));
}

}  // namespace palpate::command
