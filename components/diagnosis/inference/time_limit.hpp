// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <utility>

namespace palpate::diagnosis {

/// When a search takes the shortest way to its end.
class TimeLimit {
 public:
  /// Never.
  TimeLimit() = default;
  /// `limit_s` from now, s; not positive: never. It is also over once `stop_requested` says so.
  explicit TimeLimit(double limit_s, std::function<bool()> stop_requested = {})
      : stop_requested_(std::move(stop_requested)) {
    if (limit_s <= 0.0) return;
    end_ = Clock::now() +
           std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limit_s));
  }

  bool IsOver() const { return Clock::now() >= end_ || IsStopped(); }
  bool IsStopped() const { return stop_requested_ && stop_requested_(); }
  /// What another limit is to be made of that ends then.
  double left_s() const {
    constexpr double kOver_s = 1e-3;
    if (end_ == Clock::time_point::max()) return 0.0;
    return std::max(kOver_s, std::chrono::duration<double>(end_ - Clock::now()).count());
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point end_ = Clock::time_point::max();
  std::function<bool()> stop_requested_;
};

/// How many of `all` samples take at most `limit_s` (not positive: no limit) at `each_s`. Not below
/// 10: fewer tell nothing.
inline std::size_t SamplesWithin(double limit_s, double each_s, std::size_t all) {
  constexpr std::size_t kFewest = 10;
  const double affordable = limit_s / each_s;
  const bool enough = limit_s <= 0.0 || !(affordable < static_cast<double>(all));
  if (enough || all <= kFewest) return all;
  return std::max(kFewest, static_cast<std::size_t>(affordable));
}

}  // namespace palpate::diagnosis
