// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <thread>

namespace palpate::app {

/// A key of the keyboard: a character, or one of these.
enum class OperatorKey : int { kUp = 256, kDown, kRight, kLeft };
constexpr OperatorKey OperatorKeyOf(char character) {
  return static_cast<OperatorKey>(static_cast<unsigned char>(character));
}

/// Makes keys of the bytes that a terminal sends, where arrows are three of them.
class OperatorKeyDecoder {
 public:
  /// The key that ends with this byte; nullopt: more must come, or a key that nobody uses.
  std::optional<OperatorKey> Add(char byte);

 private:
  std::string sequence_;  ///< so far, from ESC on
};

/// Calls for each key that is pressed in the terminal of the standard input; does nothing where it
/// is no terminal. One object at a time; the terminal is as before when it goes.
class OperatorKeys {
 public:
  /// `on_key` is called from a thread of its own. Throws RunError where the system has no pipe.
  explicit OperatorKeys(std::function<void(OperatorKey)> on_key);
  ~OperatorKeys();
  OperatorKeys(const OperatorKeys&) = delete;
  OperatorKeys& operator=(const OperatorKeys&) = delete;

 private:
  void Run();

  std::function<void(OperatorKey)> on_key_;
  std::array<int, 2> quit_{-1, -1};
  std::thread thread_;
};

}  // namespace palpate::app
