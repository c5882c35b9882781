// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "libs/core/cable_reading.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// Criterion for cables at rest.
struct RestSettings {
  double still_s = 1.0;   ///< duration without motion
  double still_m = 5e-5;  ///< largest change of a displacement without motion
  double still_N = 0.05;  ///< the same of a tension
};

/// Detects when the robot's cables are at rest. A stamp that goes back (a recording that starts
/// again) clears all readings.
class CableWatch {
 public:
  enum class State {
    kNotYet,   ///< no readings of that time yet
    kMoving,   ///< or too few readings, or a gap longer than half of still_s
    kResting,  ///< over still_s before that time
  };

  CableWatch(std::size_t cable_count, robot::CableInput preferred, const RestSettings& settings)
      : cable_count_(cable_count), preferred_(preferred), settings_(settings) {}

  void Add(CableReading reading);

  /// A robot without cables always rests.
  State At(std::int64_t stamp_ns) const;
  /// Mean inputs over still_s before a time of rest, one per cable; kNone where neither
  /// displacement nor tension is known.
  std::vector<robot::ActuatorCommand> MeanAt(std::int64_t stamp_ns) const;
  bool IsEmpty() const { return readings_.empty(); }

 private:
  std::int64_t Begin(std::int64_t stamp_ns) const;
  robot::ActuatorCommand CommandOf(const CableReading& reading, std::size_t cable) const;
  bool IsStill(std::size_t cable, std::size_t first, std::size_t last) const;

  static constexpr std::size_t kCapacity = 20000;

  std::size_t cable_count_;
  robot::CableInput preferred_;
  RestSettings settings_;
  std::deque<CableReading> readings_;  ///< ascending stamps
};

}  // namespace palpate::calibration
