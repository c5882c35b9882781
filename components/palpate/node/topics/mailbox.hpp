// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

#include "libs/dds/raw_message.hpp"

namespace palpate::command {

/// Messages on their way from DDS's thread to the one that prints. Drops the oldest where more wait
/// than `most`.
class Mailbox {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Mailbox(std::size_t most) : most_(most) {}

  void Put(dds::RawMessage message) {
    {
      const std::lock_guard lock(mutex_);
      if (messages_.size() == most_) {
        messages_.pop_front();
        ++dropped_;
      }
      messages_.push_back(std::move(message));
    }
    changed_.notify_one();
  }

  /// Makes Next() return.
  void Close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    changed_.notify_one();
  }

  /// nullopt: none has come until `deadline`, or it is closed.
  std::optional<dds::RawMessage> Next(Clock::time_point deadline) {
    std::unique_lock lock(mutex_);
    changed_.wait_until(lock, deadline, [&] { return closed_ || !messages_.empty(); });
    if (closed_ || messages_.empty()) return std::nullopt;
    dds::RawMessage message = std::move(messages_.front());
    messages_.pop_front();
    return message;
  }

  bool closed() const {
    const std::lock_guard lock(mutex_);
    return closed_;
  }
  std::uint64_t dropped() const {
    const std::lock_guard lock(mutex_);
    return dropped_;
  }

 private:
  std::size_t most_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<dds::RawMessage> messages_;
  std::uint64_t dropped_ = 0;
  bool closed_ = false;
};

}  // namespace palpate::command
