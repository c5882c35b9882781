// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

namespace palpate::command {

/// While it lives, SIGINT, SIGTERM and SIGHUP are counted and do not end this process. One at a
/// time, and none beside an app::StopSignal, which takes the first signal only.
class SignalCount {
 public:
  /// Throws RunError where the system has no pipe left.
  SignalCount();
  ~SignalCount();
  SignalCount(const SignalCount&) = delete;
  SignalCount& operator=(const SignalCount&) = delete;

  /// Signals since the last call.
  int Take();
  /// For poll(): readable where Take() is not 0.
  int file_descriptor() const;
};

}  // namespace palpate::command
