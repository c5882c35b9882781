// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>
#include <limits>
#include <utility>

namespace palpate::fem {

/// Seconds on a clock that never goes back; where it starts does not matter.
using SecondsClock = std::function<double()>;

/// std::chrono::steady_clock.
double SteadySeconds();

/// The time that a computation may take, counted from where the budget was made. The clock is
/// handed in, so that tests step it by hand.
class TimeBudget {
 public:
  /// Without end, on the steady clock.
  TimeBudget() : TimeBudget(std::numeric_limits<double>::infinity()) {}
  explicit TimeBudget(double duration_s, SecondsClock clock = SteadySeconds)
      : clock_(std::move(clock)), start_s_(clock_()), duration_s_(duration_s) {}

  double Elapsed_s() const { return clock_() - start_s_; }
  /// Whether it is used up, or would be after `ahead_s` more.
  bool Over(double ahead_s = 0.0) const { return Elapsed_s() + ahead_s >= duration_s_; }

 private:
  SecondsClock clock_;
  double start_s_ = 0.0;
  double duration_s_ = 0.0;
};

}  // namespace palpate::fem
