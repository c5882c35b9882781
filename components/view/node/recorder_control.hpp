// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "components/view/serve/out_message.hpp"
#include "libs/app/child_process.hpp"

namespace palpate::view {

/// Starts and stops a recording for the page: palpate-recorder as a process of its own. From the
/// thread that started this program, because the recorder ends with that.
class RecorderControl {
 public:
  struct Settings {
    bool allowed = false;
    std::filesystem::path program;  ///< palpate-recorder
    std::filesystem::path folder;   ///< of the files
    /// Further arguments: the domain, the robot.
    std::vector<std::string> arguments;
  };

  explicit RecorderControl(Settings settings) : settings_(std::move(settings)) {}

  /// Empty where it was done, else why not.
  std::string Set(bool on);
  /// Looks after the process.
  OutMessage State();

  bool allowed() const { return settings_.allowed; }

 private:
  using Clock = std::chrono::steady_clock;

  std::string Start();
  void LookAfter();

  Settings settings_;
  std::filesystem::path file_;
  std::string reason_;  ///< why the last one failed
  Clock::time_point start_;
  double seconds_ = 0.0;
  bool stopping_ = false;
  std::unique_ptr<app::ChildProcess> process_;
};

}  // namespace palpate::view
