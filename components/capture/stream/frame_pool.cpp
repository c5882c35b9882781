// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/stream/frame_pool.hpp"

#include <atomic>

namespace palpate::capture {

std::shared_ptr<SourceFrame> FramePool::Take() {
  for (const auto& frame : frames_) {
    if (frame.use_count() != 1) continue;
    // Whoever let it go has read its last pixel before we write the next.
    std::atomic_thread_fence(std::memory_order_acquire);
    frame->facts = FrameFacts();
    frame->camera.reset();
    return frame;
  }
  if (frames_.size() == capacity_) return nullptr;
  frames_.push_back(std::make_shared<SourceFrame>());
  return frames_.back();
}

}  // namespace palpate::capture
