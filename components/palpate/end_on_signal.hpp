// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>

#include "libs/app/stop_signal.hpp"

namespace palpate::command {

/// While it lives, SIGINT and SIGTERM end the process with app::kExitInterrupted and the line
/// "PROGRAM: interrupted: WHAT_IS_LEFT". For long work whose result is in memory alone. One at a
/// time, and none beside an app::StopSignal.
class EndOnSignal {
 public:
  /// Throws RunError as app::StopSignal does.
  EndOnSignal(const std::string& program, const std::string& what_is_left);

 private:
  app::StopSignal stop_;
};

/// The temporary folder of this process, which EndOnSignal removes before the process ends; empty:
/// none any more. Does not return while the process is ended by a signal, so that whoever removes
/// the folder calls this first.
void RemoveOnSignal(const std::filesystem::path& folder);

}  // namespace palpate::command
