// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>

#include "libs/core/status.hpp"
#include "libs/rgbd/rgbd_frame.hpp"

namespace palpate::perception {

/// Fields of /camera/frame_info that pairing needs.
struct FrameFacts {
  std::uint64_t counter = 0;
  std::uint32_t epoch = 0;
  std::int64_t received_ns = 0;  ///< when the host of the camera had it; 0: not known
};

/// Depth, colour and facts of one stamp, as far as they have come.
struct FrameSet {
  using Time = std::chrono::steady_clock::time_point;

  std::int64_t stamp_ns = 0;
  Status status = Status::Ok();  ///< the first thing that is wrong with a part
  std::optional<rgbd::DepthImage> depth;
  std::optional<rgbd::ColorImage> color;
  std::optional<FrameFacts> facts;
  Time since;  ///< when the first part came
  Time taken;  ///< when the set was taken from the pairing
};

/// Puts the parts of frame sets together by their stamps, in whatever order they come.
class FramePairing {
 public:
  using Time = FrameSet::Time;

  explicit FramePairing(std::chrono::steady_clock::duration wait) : wait_(wait) {}

  /// The set that a part of this stamp belongs to; nullptr where it comes too late, that is, where
  /// a set of this stamp or a later one was taken already.
  FrameSet* At(std::int64_t stamp_ns, Time now);

  /// The newest set that is `whole`; older ones are dropped. Where none is: the oldest one that has
  /// waited long enough, if it has a depth image.
  std::optional<FrameSet> Take(const std::function<bool(const FrameSet&)>& whole, Time now);

  /// When the next set has waited long enough; nullopt: none waits.
  std::optional<Time> NextOverdue() const;

  /// A camera was opened: from now on frames may have any stamp, and those before its first one, or
  /// of another epoch, are none of its.
  void Restart(std::int64_t first_stamp_ns, std::uint32_t epoch);

  /// Of the set taken last.
  std::optional<std::int64_t> last_stamp_ns() const { return last_stamp_ns_; }
  /// Sets that a newer one overtook, or that never had a depth image.
  std::uint64_t dropped() const { return dropped_; }

 private:
  using Sets = std::map<std::int64_t, FrameSet>;

  FrameSet TakeOut(Sets::iterator set, Time now);
  std::optional<FrameSet> TakeOverdue(Time now);

  static constexpr std::size_t kMostSets = 16;

  std::chrono::steady_clock::duration wait_;
  Sets sets_;
  std::optional<std::int64_t> last_stamp_ns_;
  std::uint64_t dropped_ = 0;
};

}  // namespace palpate::perception
