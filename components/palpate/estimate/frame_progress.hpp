// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>

#include "components/palpate/progress_line.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::command {

/// The progress line of replays, for offline::ReplayLimits::progress.
class FrameProgress {
 public:
  /// `body` must outlive it: it says what makes estimates of this robot faster.
  explicit FrameProgress(const robot::RobotBody& body) : body_(body) {}

  /// A recording begins with `done` 0.
  void Update(int done, int total);
  /// Takes the line off the terminal.
  void End() { line_.reset(); }

 private:
  const robot::RobotBody& body_;
  std::optional<ProgressLine> line_;
};

}  // namespace palpate::command
