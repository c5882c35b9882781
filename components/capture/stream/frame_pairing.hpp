// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>

#include "components/capture/frame_source.hpp"

namespace palpate::capture {

/// Puts frames of a depth camera and of a colour camera together that were taken at nearly the same
/// time (stamp_host_ns). Each queue is bounded; what finds no partner is dropped and counted. Not
/// thread-safe.
class FramePairing {
 public:
  using Frame = std::shared_ptr<SourceFrame>;

  /// `tolerance_ns`: half a period of the depth camera, say.
  explicit FramePairing(std::int64_t tolerance_ns, std::size_t capacity = 8)
      : tolerance_ns_(tolerance_ns), capacity_(capacity) {}

  void AddDepth(Frame frame);
  void AddColor(Frame frame);
  /// The oldest depth frame with the colour image nearest to it in time, moved into it; nothing
  /// while a nearer image may still come.
  std::optional<Frame> Next();
  std::uint64_t unpaired() const { return unpaired_; }

 private:
  void Keep(std::deque<Frame>* queue, Frame frame);
  void DropColorBefore(std::int64_t stamp_ns);

  std::int64_t tolerance_ns_;
  std::size_t capacity_;
  std::deque<Frame> depth_;  ///< rising stamps
  std::deque<Frame> color_;
  std::int64_t last_color_ns_ = 0;
  std::int64_t color_period_ns_ = 0;  ///< between the last two images; 0: unknown
  std::uint64_t unpaired_ = 0;
};

}  // namespace palpate::capture
