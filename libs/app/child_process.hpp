// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace palpate::app {

/// A program that this process started. It ends with this object, or when this process dies.
class ChildProcess {
 public:
  /// `environment` is added to ours; standard output and error go to `log`. Throws RunError where
  /// the program cannot be started or the log not be written.
  ChildProcess(const std::filesystem::path& program, const std::vector<std::string>& arguments,
               const std::map<std::string, std::string>& environment,
               const std::filesystem::path& log);
  /// Stop().
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Lowers the priority (nice 5): processes of normal priority run first where cores are scarce.
  /// Call it right after the start, so that it holds for every thread of the program.
  void GiveWay();

  /// Exit code (128 + signal where a signal ended it), or nullopt while it runs.
  std::optional<int> ExitCode();

  /// Waits for the end, however long it takes. Returns the exit code.
  int Wait();

  /// SIGINT, once, as Ctrl-C sends it.
  void Interrupt();

  /// SIGINT, and where that does not end it within 5 s each, SIGTERM, SIGKILL. Returns the exit
  /// code.
  int Stop();

  const std::string& name() const { return name_; }
  const std::filesystem::path& log() const { return log_; }

 private:
  std::string name_;
  std::filesystem::path log_;
  pid_t pid_ = -1;
  std::optional<int> exit_code_;
};

}  // namespace palpate::app
