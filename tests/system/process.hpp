// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace palpate::system_test {

/// What a process holds: files and sockets, threads, resident memory.
struct Holdings {
  std::size_t files = 0;
  std::size_t threads = 0;
  double memory_MiB = 0.0;
};

/// nullopt: it does not run.
std::optional<Holdings> HoldingsOf(pid_t pid);

/// A program of the build, running. Killed when this goes out of scope.
class Process {
 public:
  /// `name`: of a program in the bin folder of the build. Both its outputs go to `log`.
  /// `wrapper`: a command that starts it, e.g. {"ip", "netns", "exec", "robot"}.
  Process(const std::string& name, const std::vector<std::string>& arguments,
          const std::filesystem::path& log, const std::vector<std::string>& wrapper = {});
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  pid_t pid() const { return pid_; }
  void Signal(int signal);
  /// Waits for its end, at most so long: its exit code, or minus the signal that ended it.
  /// nullopt: it still runs.
  std::optional<int> Wait(std::chrono::seconds at_most);
  /// Processor time that it has used until now, s.
  double CpuTime_s() const;
  using Holdings = system_test::Holdings;
  Holdings Holds() const { return HoldingsOf(pid_).value_or(Holdings()); }
  /// What it has written until now.
  std::string Output() const;

 private:
  pid_t pid_ = -1;
  std::filesystem::path log_;
};

/// Runs a program to its end, at most ten minutes; its exit code as Wait() has it.
std::optional<int> RunProgram(const std::string& name, const std::vector<std::string>& arguments,
                              const std::filesystem::path& log);

}  // namespace palpate::system_test
