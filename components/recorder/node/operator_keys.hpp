// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <array>
#include <functional>
#include <thread>

namespace palpate::recorder {

/// Calls for each key that is pressed in the terminal of the standard input; does nothing where it
/// is no terminal. One object at a time; the terminal is as before when it goes.
class OperatorKeys {
 public:
  /// `on_key` is called from a thread of its own. Throws RunError where the system has no pipe.
  explicit OperatorKeys(std::function<void(char)> on_key);
  ~OperatorKeys();
  OperatorKeys(const OperatorKeys&) = delete;
  OperatorKeys& operator=(const OperatorKeys&) = delete;

 private:
  void Run();

  std::function<void(char)> on_key_;
  std::array<int, 2> quit_{-1, -1};
  std::thread thread_;
};

}  // namespace palpate::recorder
