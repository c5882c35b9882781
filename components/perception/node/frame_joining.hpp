// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "components/perception/node/frame_pairing.hpp"
#include "libs/experiment/images/joint_frames.hpp"

namespace palpate::perception {

struct FrameJoiningTuning {
  /// Which frames belong together: as offline, so that the same ones are joined.
  experiment::JointFramesTuning together;
  /// Periods of a camera of which the median counts. More: slower to follow a new rate; fewer: one
  /// lost frame changes it.
  std::size_t periods = 15;
  /// Frames in a row that waited for a camera in vain, from which on none waits for it. More: a
  /// camera that is gone delays more frames; fewer: one that is late now and then is left out.
  int misses = 3;
};

/// Frame sets of several cameras at one time.
struct JointSet {
  std::int64_t stamp_ns = 0;                  ///< of the first of the cameras that have one
  std::vector<std::optional<FrameSet>> sets;  ///< [cameras] nullopt: it has none of this time
  FrameSet::Time taken;                       ///< when it was known to be whole
};

/// Joins frame sets of cameras by their stamps as they come: the frames nearest in time, each used
/// once, with rising stamps. A frame waits for those of the other cameras up to a longest time, and
/// goes on without them then. With one camera nothing waits.
class FrameJoining {
 public:
  using Time = FrameSet::Time;

  FrameJoining(std::size_t cameras, std::chrono::steady_clock::duration wait,
               const FrameJoiningTuning& tuning = {});

  /// A set of one camera. One whose stamp is below that of the camera's last set begins again:
  /// nothing of before is joined with it. One that comes after the frame it belongs to is dropped.
  void Add(std::size_t camera, FrameSet set);

  /// The next frame whose cameras are known; nullopt: none has come, or it waits.
  std::optional<JointSet> Take(Time now);

  /// When the next frame has waited long enough; nullopt: none waits.
  std::optional<Time> NextOverdue() const;

  /// Sets that came after their frame.
  std::uint64_t dropped() const { return dropped_; }

 private:
  struct Camera {
    std::deque<FrameSet> waiting;
    std::deque<std::int64_t> stamps_ns;  ///< of its last sets
    /// Up to here its sets would have been part of the last frame, which went on without it.
    std::optional<std::int64_t> missed_until_ns;
    int misses = 0;
  };

  /// The median period of a camera; nullopt: too few sets have come.
  std::optional<std::int64_t> Period_ns(const Camera& camera) const;
  std::int64_t LongestApart_ns() const;
  /// Whether a set of the camera, of which none waits, may come with a stamp up to `end_ns`.
  bool MayCome(const Camera& camera, std::int64_t end_ns, std::int64_t longest_ns) const;
  const FrameSet* Earliest() const;
  JointSet Join(std::int64_t end_ns, std::int64_t longest_ns, Time now);
  std::optional<JointSet> TakeNext(Time now);

  std::vector<Camera> cameras_;
  std::chrono::steady_clock::duration wait_;
  FrameJoiningTuning tuning_;
  std::optional<std::int64_t> last_stamp_ns_;  ///< of the last frame
  std::uint64_t dropped_ = 0;
};

}  // namespace palpate::perception
