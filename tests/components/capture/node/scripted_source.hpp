// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <mutex>
#include <utility>
#include <vector>

#include "components/capture/frame_source.hpp"
#include "components/capture/stream/frame_queue.hpp"

namespace palpate::capture {

/// What a test lets a source give.
class Script {
 public:
  void Send(std::shared_ptr<SourceFrame> frame) { queue_.Push(std::move(frame)); }
  void Set(SourceHealth health) {
    const std::lock_guard lock(mutex_);
    health_ = std::move(health);
  }
  FramePtr Next(double timeout_s) { return queue_.Pop(timeout_s); }
  SourceHealth Health() const {
    const std::lock_guard lock(mutex_);
    return health_;
  }

 private:
  FrameQueue queue_{16};
  mutable std::mutex mutex_;
  SourceHealth health_;
};

class ScriptedSource : public FrameSource {
 public:
  explicit ScriptedSource(Script& script) : script_(script) {}
  FramePtr Next(double timeout_s) override { return script_.Next(timeout_s); }
  SourceHealth Health() const override { return script_.Health(); }

 private:
  Script& script_;
};

}  // namespace palpate::capture
