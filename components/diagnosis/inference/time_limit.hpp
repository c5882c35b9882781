// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <algorithm>
#include <chrono>

namespace palpate::diagnosis {

/// When a search takes the shortest way to its end.
class TimeLimit {
 public:
  /// Never.
  TimeLimit() = default;
  /// `limit_s` from now, s; not positive: never.
  explicit TimeLimit(double limit_s) {
    if (limit_s <= 0.0) return;
    end_ = Clock::now() +
           std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limit_s));
  }

  bool IsOver() const { return Clock::now() >= end_; }
  /// What another limit is to be made of that ends then.
  double left_s() const {
    constexpr double kOver_s = 1e-3;
    if (end_ == Clock::time_point::max()) return 0.0;
    return std::max(kOver_s, std::chrono::duration<double>(end_ - Clock::now()).count());
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point end_ = Clock::time_point::max();
};

}  // namespace palpate::diagnosis
