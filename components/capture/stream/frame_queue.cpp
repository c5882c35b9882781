// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/stream/frame_queue.hpp"

#include <chrono>
#include <utility>

namespace palpate::capture {

void FrameQueue::Put(FramePtr frame) {
  slots_[(first_ + size_) % slots_.size()] = std::move(frame);
  ++size_;
  changed_.notify_all();
}

void FrameQueue::Push(FramePtr frame) {
  FramePtr oldest;  // released outside the lock
  const std::lock_guard lock(mutex_);
  if (closed_) return;
  if (size_ == slots_.size()) {
    oldest = std::move(slots_[first_]);
    first_ = (first_ + 1) % slots_.size();
    --size_;
    ++dropped_;
  }
  Put(std::move(frame));
}

bool FrameQueue::PushWhenRoom(FramePtr frame) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return closed_ || size_ < slots_.size(); });
  if (closed_) return false;
  Put(std::move(frame));
  return true;
}

FramePtr FrameQueue::Pop(double timeout_s) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, std::chrono::duration<double>(timeout_s),
                    [&] { return closed_ || size_ > 0; });
  if (size_ == 0) return nullptr;
  FramePtr frame = std::move(slots_[first_]);
  first_ = (first_ + 1) % slots_.size();
  --size_;
  changed_.notify_all();
  return frame;
}

void FrameQueue::Close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  changed_.notify_all();
}

std::uint64_t FrameQueue::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

bool FrameQueue::drained() const {
  const std::lock_guard lock(mutex_);
  return closed_ && size_ == 0;
}

}  // namespace palpate::capture
