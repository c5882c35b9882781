// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/link/device_closer.hpp"

#include <utility>

namespace palpate::capture {

DeviceCloser::~DeviceCloser() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void DeviceCloser::Take(std::shared_ptr<void> object) {
  {
    const std::lock_guard lock(mutex_);
    objects_.push_back(std::move(object));
  }
  changed_.notify_all();
}

void DeviceCloser::Run() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stop_ || !objects_.empty(); });
    if (objects_.empty()) return;
    auto object = std::move(objects_.front());
    objects_.pop_front();
    lock.unlock();
    object.reset();
    lock.lock();
  }
}

}  // namespace palpate::capture
