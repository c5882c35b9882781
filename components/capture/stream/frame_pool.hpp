// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "components/capture/frame_source.hpp"

namespace palpate::capture {

/// Frames with their pixels, used again and again: once as many exist as are ever held at a time,
/// taking one allocates nothing. For one taking thread; frames may be released in any.
class FramePool {
 public:
  explicit FramePool(std::size_t capacity) : capacity_(capacity) { frames_.reserve(capacity); }

  /// A free frame (its pixels are stale), or nullptr where `capacity` of
  /// them are held.
  std::shared_ptr<SourceFrame> Take();
  std::size_t made() const { return frames_.size(); }

 private:
  std::size_t capacity_;
  std::vector<std::shared_ptr<SourceFrame>> frames_;
};

}  // namespace palpate::capture
