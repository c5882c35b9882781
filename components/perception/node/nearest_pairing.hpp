// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "components/perception/node/frame_pairing.hpp"

namespace palpate::perception {

/// Period of a stream: the median of the last steps between its stamps, so that jitter and single
/// lost frames do not count.
class StreamPeriod {
 public:
  void Add(std::int64_t stamp_ns);
  void Clear() { *this = {}; }
  /// nullopt: fewer than three steps so far.
  std::optional<std::int64_t> period_ns() const;

 private:
  static constexpr std::size_t kMostSteps = 31;

  std::optional<std::int64_t> last_ns_;
  std::deque<std::int64_t> steps_ns_;
};

/// Pairs each depth image with the colour image that is nearest in time, for streams whose stamps
/// differ. A colour image may go with more than one depth image.
class NearestPairing {
 public:
  using Time = FrameSet::Time;

  /// `wait`: longest wait of a depth image for colour. `tolerance_s`: largest difference of the
  /// stamps; 0: three quarters of the period of the slower stream. The nearest image of a stream
  /// without loss is at most half a period away, and one whose neighbour was lost a whole period.
  NearestPairing(std::chrono::steady_clock::duration wait, double tolerance_s);

  /// Takes the parts of `set`: depth, status, stamp. False where its stamp is that of the last one.
  /// A stamp that falls begins a new sequence: what waits is dropped.
  bool AddDepth(FrameSet set, Time now);
  void AddColor(std::int64_t stamp_ns, rgbd::ColorImage image, const Status& status);

  /// The newest depth image whose nearest colour image is known, with it; older ones are dropped.
  /// Where there is none, the oldest that has waited long enough, with colour within the tolerance
  /// or without. `with_color` false: none is waited for.
  std::optional<FrameSet> Take(bool with_color, Time now);
  std::optional<Time> NextOverdue() const;

  std::optional<std::int64_t> last_stamp_ns() const { return last_stamp_ns_; }  ///< taken
  std::uint64_t dropped() const { return dropped_; }
  /// In use; nullopt: the periods are not known yet, and any difference is allowed.
  std::optional<std::int64_t> tolerance_ns() const;

 private:
  struct Color {
    std::int64_t stamp_ns = 0;
    rgbd::ColorImage image;
    Status status;
  };

  const Color* Nearest(std::int64_t stamp_ns) const;
  bool IsDecided(std::int64_t stamp_ns) const;
  FrameSet TakeOut(std::size_t index, Time now);

  static constexpr std::size_t kMostDepths = 16;
  static constexpr std::size_t kMostColors = 16;

  std::chrono::steady_clock::duration wait_;
  std::int64_t given_tolerance_ns_;
  StreamPeriod depth_period_;
  StreamPeriod color_period_;
  std::deque<FrameSet> depths_;  ///< stamps rise
  std::deque<Color> colors_;     ///< stamps rise
  std::optional<std::int64_t> last_depth_ns_;
  std::optional<std::int64_t> last_stamp_ns_;
  std::uint64_t dropped_ = 0;
};

}  // namespace palpate::perception
