// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "components/palpate/launch/process_supervisor.hpp"

namespace palpate::command {

/// What is executed.
struct ChildCommand {
  std::filesystem::path program;  ///< absolute
  std::vector<std::string> arguments;
  std::map<std::string, std::string> environment;  ///< added to ours
  int nice = 0;                                    ///< added to ours
};

/// A running program in a process group of its own. Its input is empty, both its outputs go to one
/// pipe, and it has a socket of its own to say that it is ready.
class Child {
 public:
  /// Starts it. `number`: different for each child of this process. Throws RunError with the cause.
  Child(const ChildCommand& command, int number);
  /// Kills what is left of the group.
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  pid_t pid() const { return pid_; }
  /// For poll(): readable where there is output, or READY.
  int output() const { return output_; }
  int notify() const { return notify_; }

  /// What was written since the last call; does not wait. Nothing any more: the pipe is closed.
  std::optional<std::string> ReadOutput();
  /// Whether READY=1 has come since the last call.
  bool ReadReady();
  void Signal(int signal) const;
  /// Its end, with what is left of its group killed; nullopt: it still runs.
  std::optional<ProcessEnd> TakeEnd();

 private:
  pid_t pid_ = -1;  // and of the group
  int output_ = -1;
  int notify_ = -1;
  bool ended_ = false;
};

/// Where `name` is executable: the file itself, or of the folders in PATH. Empty: nowhere.
std::filesystem::path FindExecutable(const std::string& name);

}  // namespace palpate::command
