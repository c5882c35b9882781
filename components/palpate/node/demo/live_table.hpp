// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>

#include "libs/core/clock.hpp"

namespace palpate::command {

/// Shows the newest line on the standard output: on a terminal rewritten in place, cut to its
/// width, a few times a second; elsewhere one line each second.
class LiveTable {
 public:
  explicit LiveTable(Clock clock = MonotonicNow_ns);
  ~LiveTable();
  LiveTable(const LiveTable&) = delete;
  LiveTable& operator=(const LiveTable&) = delete;

  void Show(const std::string& line);

 private:
  Clock clock_;
  bool terminal_;
  std::int64_t shown_ns_;
  bool on_screen_ = false;
};

}  // namespace palpate::command
