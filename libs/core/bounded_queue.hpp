// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

namespace palpate {

/// Hands items from one thread to another, in order and never more than `capacity` at once. Of the
/// items marked as overtakable only the newest waits. Where it is full, Push() drops the oldest
/// item and PushWhenRoom() waits.
template <typename T>
class BoundedQueue {
 public:
  explicit BoundedQueue(size_t capacity) : capacity_(capacity) {}

  void Push(T item, bool overtakable) {
    {
      const std::lock_guard lock(mutex_);
      if (overtakable) {
        dropped_ += std::erase_if(waiting_, [](const Waiting& old) { return old.overtakable; });
      }
      if (waiting_.size() == capacity_) {
        waiting_.pop_front();
        ++dropped_;
      }
      waiting_.push_back({std::move(item), overtakable});
    }
    changed_.notify_one();
  }

  /// Waits while `capacity` items wait. False after Stop().
  [[nodiscard]] bool PushWhenRoom(T item) {
    {
      std::unique_lock lock(mutex_);
      has_room_.wait(lock, [this] { return stopped_ || waiting_.size() < capacity_; });
      if (stopped_) return false;
      waiting_.push_back({std::move(item), false});
    }
    changed_.notify_one();
    return true;
  }

  /// The oldest item, or nullopt.
  std::optional<T> TryPop() {
    const std::lock_guard lock(mutex_);
    return PopLocked();
  }

  /// The oldest item; waits for one. nullopt after Stop().
  std::optional<T> Pop() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return stopped_ || !waiting_.empty(); });
    return stopped_ ? std::nullopt : PopLocked();
  }

  void Stop() {
    {
      const std::lock_guard lock(mutex_);
      stopped_ = true;
    }
    changed_.notify_all();
    has_room_.notify_all();
  }

  /// Items that were overtaken, or pushed out because too many waited.
  uint64_t dropped() const {
    const std::lock_guard lock(mutex_);
    return dropped_;
  }

 private:
  struct Waiting {
    T item;
    bool overtakable;
  };

  std::optional<T> PopLocked() {
    if (waiting_.empty()) return std::nullopt;
    std::optional<T> item(std::move(waiting_.front().item));
    waiting_.pop_front();
    has_room_.notify_one();
    return item;
  }

  const size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::condition_variable has_room_;
  std::deque<Waiting> waiting_;
  uint64_t dropped_ = 0;
  bool stopped_ = false;
};

}  // namespace palpate
