// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "libs/dds/reader.hpp"
#include "rosgraph_msgs/msg/Clock.hpp"

namespace palpate::dds {

/// The time of a node as ROS 2 has it: the system clock, or with use_sim_time what /clock says.
/// Safe from any thread.
class RosClock {
 public:
  /// The system clock.
  RosClock() = default;
  /// The last message on `topic`, read under `ros_name`. Throws RunError where DDS refuses.
  RosClock(dds_entity_t participant, const TopicSettings& topic, const std::string& ros_name);

  /// ns since 1970; with /clock 0 until its first message.
  std::int64_t Now_ns();
  /// The same time by the clock that stamps the camera's frames, to judge their age; this host's
  /// where the offset is not known, and with /clock.
  std::int64_t NowOfFrames_ns() { return Now_ns() + (reader_ ? 0 : frames_offset_ns_.load()); }
  /// Maps a stamp of the cable inputs to the clock of the frames, in the same way.
  std::int64_t CableStampOfFrames_ns(std::int64_t stamp_ns) const {
    return stamp_ns + (reader_ ? 0 : frames_offset_ns_ - cables_offset_ns_);
  }
  /// Clocks of other hosts minus this host's (ClockOffsets).
  void SetOffsets(std::int64_t frames_ns, std::int64_t cables_ns) {
    frames_offset_ns_ = frames_ns;
    cables_offset_ns_ = cables_ns;
  }
  /// Of /clock; nullptr: the system clock.
  const Endpoint* reader() const { return reader_ ? &*reader_ : nullptr; }

 private:
  std::mutex mutex_;
  std::optional<Reader<idl::rosgraph_msgs::Clock>> reader_;
  std::int64_t last_ns_ = 0;
  std::atomic<std::int64_t> frames_offset_ns_{0};
  std::atomic<std::int64_t> cables_offset_ns_{0};
};

}  // namespace palpate::dds
