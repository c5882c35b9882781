// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "components/capture/frame_source.hpp"

namespace palpate::capture {

/// The bounded hand-over from a source's thread to its reader. Allocates nothing after the start.
class FrameQueue {
 public:
  explicit FrameQueue(std::size_t capacity) : slots_(capacity) {}

  /// Never waits: where the queue is full the oldest frame is dropped and counted.
  void Push(FramePtr frame);
  /// Waits for room. False, without the frame, once closed.
  bool PushWhenRoom(FramePtr frame);
  /// The oldest frame; nullptr where none came for `timeout_s`, or none will come: closed and
  /// empty.
  FramePtr Pop(double timeout_s);
  void Close();
  std::uint64_t dropped() const;
  bool drained() const;  ///< closed, and all was taken

 private:
  void Put(FramePtr frame);

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<FramePtr> slots_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  std::uint64_t dropped_ = 0;
  bool closed_ = false;
};

}  // namespace palpate::capture
