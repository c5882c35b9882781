// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>

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
  void Update(int done);

  /// Takes the line off the terminal, before something else is printed there.
  void Clear();

  /// "12 of 40 rows, 3.4 rows/s, 8 s to go"
  static std::string Text(const std::string& unit, int done, int total, double elapsed_s);

 private:
  std::string unit_;
  int total_;
  Clock clock_;
  std::int64_t start_ns_;
  std::int64_t shown_ns_;
  bool terminal_;
  bool on_screen_ = false;
};

}  // namespace palpate::command
