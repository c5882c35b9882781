// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <sys/types.h>

#include "components/palpate/system/system_file.hpp"

namespace palpate::command {

/// A small process that outlives this one. Where this one dies, also by SIGKILL, it stops the
/// process groups that are left: SIGINT, SIGTERM, SIGKILL. It ends with this object, or after that.
class Guardian {
 public:
  /// Throws RunError where the system has no process or pipe left.
  explicit Guardian(const StopPlan& stop);
  ~Guardian();
  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;

  void Watch(pid_t process_group);
  /// The group has ended.
  void Forget(pid_t process_group);

 private:
  void Tell(pid_t word);

  pid_t pid_ = -1;
  int pipe_ = -1;  // write end
};

}  // namespace palpate::command
