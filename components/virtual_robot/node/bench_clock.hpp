// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>

namespace palpate::virtual_robot {

/// Keeps the bench's time in step with a clock that is handed in: one tick each period, all ticks
/// on one grid. Where the computer falls behind, ticks are left out.
class BenchClock {
 public:
  /// Both in s, > 0. A tick moves the bench's time by at most `max_step_s`, and by at least one
  /// period.
  BenchClock(double period_s, double max_step_s);

  /// The bench's time is 0 at `now_s`.
  void Start(double now_s);

  /// When the next tick is due, on the clock of Start.
  double Due_s() const { return due_s_; }
  /// Takes the tick that is due (now_s >= Due_s()): the bench's time is then as near to the clock
  /// as ticks and max_step_s allow. Returns it.
  double Tick(double now_s);

  double bench_s() const { return bench_s_; }
  /// Periods that were left out since the start, because they went by unused.
  std::uint64_t missed() const { return missed_; }

 private:
  double period_s_;
  double max_step_s_;
  double due_s_ = 0.0;
  double bench_s_ = 0.0;
  std::uint64_t missed_ = 0;
};

}  // namespace palpate::virtual_robot
