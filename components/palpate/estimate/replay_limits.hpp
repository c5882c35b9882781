// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>
#include <string>
#include <vector>

#include "libs/robot/robot_body.hpp"

namespace palpate::command {

/// Which frames of a recording a replay estimates.
struct ReplayLimits {
  double rate_Hz = 0.0;  ///< largest frame rate; 0: all frames
  /// Asked before each frame; true ends the replay. Empty: never.
  std::function<bool()> stop_requested;

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

/// What makes estimates of this robot faster.
std::string AdviceWhereSlow(const robot::RobotBody& body);

}  // namespace palpate::command
