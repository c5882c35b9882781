// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "libs/core/status.hpp"
#include "libs/dds/participant.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// Calibrations on /calibration, and whether they may be used.
class CalibrationInput {
 public:
  struct Verdict {
    /// kInvalidInput: not finite, or of another robot, mesh, element or material. kStale: older
    /// than the one in use.
    Status status;
    robot::CalibrationFile calibration;
  };

  /// `model` must outlive it.
  CalibrationInput(dds::Participant& participant, const robot::RobotModel& model);

  dds::Reader<idl::palpate_msgs::Calibration>& reader() { return reader_; }
  void SetInUse(const robot::CalibrationFile& calibration);
  /// Calibrations that came since the last call, without repetitions of the one in use. One that is
  /// ok is in use from now on.
  std::vector<Verdict> Take();

 private:
  Verdict Judge(const idl::palpate_msgs::Calibration& message) const;

  const robot::RobotModel& model_;
  dds::Reader<idl::palpate_msgs::Calibration> reader_;
  std::string date_utc_;  ///< of the one in use; empty: none
  std::string data_hash_;
};

/// The message as a calibration file. kInvalidInput for numbers that are not finite, standard
/// errors below 0, moduli not above 0, a pose that is no rigid motion, and a further camera that is
/// there twice.
Status FromCalibration(const idl::palpate_msgs::Calibration& message,
                       robot::CalibrationFile* calibration);

}  // namespace palpate::force_estimation
