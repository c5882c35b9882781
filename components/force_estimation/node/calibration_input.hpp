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

/// What comes on /calibration, and whether it may be taken.
class CalibrationInput {
 public:
  struct Verdict {
    /// kInvalidInput: numbers that are none, or another robot's, mesh's, element's or material's.
    /// kStale: older than the one in use.
    Status status;
    robot::CalibrationFile calibration;
  };

  /// `model` must outlive it.
  CalibrationInput(dds::Participant& participant, const robot::RobotModel& model);

  dds::Reader<idl::palpate_msgs::Calibration>& reader() { return reader_; }
  void SetInUse(const robot::CalibrationFile& calibration);
  /// What waits, without the one in use come again. What is ok counts as in use.
  std::vector<Verdict> Take();

 private:
  Verdict Judge(const idl::palpate_msgs::Calibration& message) const;

  const robot::RobotModel& model_;
  dds::Reader<idl::palpate_msgs::Calibration> reader_;
  std::string date_utc_;  ///< of the one in use; empty: none
  std::string data_hash_;
};

/// The message as a calibration file. kInvalidInput for numbers that are not finite, standard
/// errors below 0, moduli that are not above 0, a pose that is none.
Status FromCalibration(const idl::palpate_msgs::Calibration& message,
                       robot::CalibrationFile* calibration);

}  // namespace palpate::force_estimation
