// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "libs/core/cable_reading.hpp"
#include "libs/core/status.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// What a force that is read of an actuator becomes: (1 + gain) of it, and offset_N.
struct ForceCorrection {
  double gain = 0.0;
  double offset_N = 0.0;

  double Force_N(double read_N) const { return (1.0 + gain) * read_N + offset_N; }
};

/// The last cable inputs, to interpolate those of a frame's time.
class CableHistory {
 public:
  CableHistory(size_t cable_count, robot::CableInput preferred)
      : cable_count_(cable_count),
        preferred_(preferred),
        drives_(cable_count),
        forces_(cable_count) {}

  /// Calibration of the actuators by which displacements are corrected from now on; initially none.
  void SetDrives(const std::vector<robot::DriveCalibration>& drives) { drives_ = drives; }
  /// The same of forces: calibration of the pressure sensor of each chamber; initially none.
  void SetForceCorrections(const std::vector<ForceCorrection>& forces) { forces_ = forces; }

  /// A stamp below the last one means that time went back: earlier readings are dropped.
  void Add(CableReading reading);
  /// A sequence of frames began. `time_went_back`: before the end of the one before.
  void BeginSequence(bool time_went_back);

  /// Commands at `stamp_ns`: those of that stamp, or interpolated linearly; nullopt where the
  /// readings do not cover the time (yet).
  std::optional<std::vector<robot::ActuatorCommand>> At(int64_t stamp_ns) const;
  /// The last commands at or before `stamp_ns`; kStale, with their age, where they are older than
  /// `max_age_s`.
  Status LastBefore(int64_t stamp_ns, double max_age_s,
                    std::vector<robot::ActuatorCommand>* commands) const;

 private:
  std::vector<robot::ActuatorCommand> Commands(const CableReading& before,
                                               const CableReading& after, double share) const;

  static constexpr size_t kCapacity = 1000;

  size_t cable_count_;
  robot::CableInput preferred_;
  std::vector<robot::DriveCalibration> drives_;  ///< [cable_count_]
  std::vector<ForceCorrection> forces_;          ///< [cable_count_]
  std::deque<CableReading> readings_;            ///< rising stamps
  bool went_back_ = true;                        ///< since the last sequence began
};

}  // namespace palpate::force_estimation
