// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "libs/core/clock.hpp"

namespace palpate::command {

/// Progress of a longer computation on the standard error output: on a terminal one line that is
/// rewritten, with rate and remaining time; elsewhere a plain line now and then. Prints nothing
/// about work that takes less than a second.
class ProgressLine {
 public:
  /// `unit`: what is counted, in the plural ("rows").
  ProgressLine(std::string unit, int total, Clock clock = MonotonicNow_ns);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// `done` of the total are done.
  void Update(int done) { Update(done, 0.0, {}); }
  /// The same, and the share `part` (0 to 1) of the next one; `detail` says what is being done and
  /// is asked only where a line is printed.
  void Update(int done, double part, const std::function<std::string()>& detail);

  /// Printed once, as a line of its own, where the work turns out to take long: after 5 s more than
  /// 30 s are to go.
  void SetAdvice(std::string advice) { advice_ = std::move(advice); }

  /// Takes the line off the terminal, before something else is printed there.
  void Clear();

  /// "12 of 40 rows, 3.4 rows/s, 8 s to go": at the mean rate so far, in which `part` counts.
  static std::string Text(const std::string& unit, int done, int total, double elapsed_s,
                          double part = 0.0);

 private:
  void Advise(double reached, double elapsed_s);

  std::string unit_;
  int total_;
  Clock clock_;
  std::int64_t start_ns_;
  std::int64_t shown_ns_;
  bool terminal_;
  bool on_screen_ = false;
  std::string advice_;
};

}  // namespace palpate::command
