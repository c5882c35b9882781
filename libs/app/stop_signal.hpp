// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>
#include <thread>

namespace palpate::app {

/// Turns SIGINT and SIGTERM into a clean stop. The first signal sets the flag, makes
/// file_descriptor() readable and calls `on_stop` once, in a thread of its own (where it may
/// trigger a guard condition of a DDS waitset); a second one ends the process at once, as without
/// this class. One object at a time; the destructor gives the signals back.
class StopSignal {
 public:
  /// Throws RunError where the system has no pipe or thread left.
  explicit StopSignal(std::function<void()> on_stop = {});
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  bool Requested() const;
  /// For poll() only: readable from the request on. Do not read from it.
  int file_descriptor() const;
  /// Blocks until a stop is requested.
  void Wait() const;
  /// As if a signal had come.
  void Request();

 private:
  void WatchPipe();

  std::function<void()> on_stop_;
  std::thread watcher_;
};

}  // namespace palpate::app
