// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>

namespace palpate::capture {

/// Destroys what is handed over in a thread of its own: letting go of a camera that is gone takes
/// Aravis 2.5 s. The destructor waits until all is gone.
class DeviceCloser {
 public:
  DeviceCloser() : thread_([this] { Run(); }) {}
  ~DeviceCloser();
  DeviceCloser(const DeviceCloser&) = delete;
  DeviceCloser& operator=(const DeviceCloser&) = delete;

  void Take(std::shared_ptr<void> object);

 private:
  void Run();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::shared_ptr<void>> objects_;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace palpate::capture
