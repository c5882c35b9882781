// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

namespace palpate::system_test {

/// A component as a process, waiting for what others would send.
struct WaitingProgram {
  std::string component;
  std::vector<std::string> arguments;
  std::string Program() const;
};

/// Each component that waits without a camera, a player's file or a scenario's end. Components
/// whose topics depend on a setting are there once for each value.
std::vector<WaitingProgram> WaitingPrograms();

}  // namespace palpate::system_test
