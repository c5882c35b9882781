// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <deque>
#include <string>

namespace palpate::command {

struct WindowStatistics {
  double mean = 0.0;
  double min = 0.0;
  double max = 0.0;
  double standard_deviation = 0.0;  ///< of the values themselves, not of their mean
  std::size_t count = 0;
};

/// The last values of a stream, at most `size` of them.
class SlidingWindow {
 public:
  explicit SlidingWindow(std::size_t size) : size_(size) {}

  void Add(double value);
  void Clear() { values_.clear(); }
  const std::deque<double>& values() const { return values_; }
  /// All 0 where there is no value.
  WindowStatistics Statistics() const;

 private:
  std::size_t size_;
  std::deque<double> values_;
};

/// The lines of `ros2 topic hz`, of the intervals between messages, s.
std::string RateLines(const WindowStatistics& intervals_s);
/// The lines of `ros2 topic delay`, of the ages of messages when they came, s.
std::string DelayLines(const WindowStatistics& ages_s);
/// The lines of `ros2 topic bw`, of the sizes of messages in bytes.
std::string BandwidthLines(double bytes_per_s, const WindowStatistics& sizes);

}  // namespace palpate::command
