// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>
#include <vector>

namespace palpate::offline {

/// Which frames of a recording a replay estimates, and who is told.
struct ReplayLimits {
  double rate_Hz = 0.0;  ///< largest frame rate; 0: all frames
  /// Asked before each frame; true ends the replay. Empty: never.
  std::function<bool()> stop_requested;
  /// Called before the first frame of a recording, with `done` 0, and after each. Empty: nobody.
  std::function<void(int done, int total)> progress;

  void Report(int done, int total) const {
    if (progress) progress(done, total);
  }
  bool StopRequested() const { return stop_requested && stop_requested(); }
};

/// How far a replay came.
struct ReplayCount {
  int done = 0;                    ///< frames that were estimated
  int total = 0;                   ///< frames that were to be
  bool ends_with_contact = false;  ///< it was to end where perception locates a contact

  bool complete() const { return done == total; }
};

/// For each of the rising times whether its frame is kept, so that at most `rate_Hz` frames a
/// second are: the first frame of each period, counted from the first time. 0: all.
std::vector<bool> KeptFrames(const std::vector<double>& t_s, double rate_Hz);

}  // namespace palpate::offline
