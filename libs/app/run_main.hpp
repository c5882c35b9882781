// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace palpate::app {

enum ExitCode : int {
  kExitDone = 0,
  kExitFailed = 1,         ///< while running
  kExitUsage = 2,          ///< wrong usage, settings or input files
  kExitInterrupted = 130,  ///< SIGINT or SIGTERM ended the work; 128 + SIGINT, as shells have it
};

/// A signal ended the work. what() says what is left of it: "after 12 of 40 samples: nothing was
/// written".
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Runs the whole of a main(): returns what `work` returns, or the exit code of what it throws,
/// with one line "program: error: cause" on the standard error output ("program: interrupted
/// after ..." for Interrupted). A RunError keeps the line ends of its list of reasons. Standard
/// output that could not be written (full disk) counts as failed.
int RunMain(const std::string& program, const std::function<int()>& work);

}  // namespace palpate::app
