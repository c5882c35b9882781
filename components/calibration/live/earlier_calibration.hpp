// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/calibration/cloud/cloud_frame.hpp"
#include "components/calibration/joint/calibration_frame.hpp"
#include "components/calibration/pose/frame_assignment.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::calibration {

/// Applies an earlier calibration to frames of this model: gravity, displacements corrected by its
/// actuators, and pressures corrected by its sensors.
void ReadAsBefore(const robot::CalibrationFile& before, const robot::RobotModel& model,
                  std::vector<CloudFrame>* frames);
void ReadAsBefore(const robot::CalibrationFile& before, const robot::RobotModel& model,
                  std::vector<CalibrationFrame>* frames);
void ReadAsBefore(const robot::CalibrationFile& before, const robot::RobotModel& model,
                  std::vector<UnlabelledFrame>* frames);

/// Adds to `file`, estimated from such frames, what it did not estimate again: moduli, Poisson's
/// ratios, gravity, size, cable routes and pose. Its actuators and pressure sensors correct the
/// earlier correction; they are composed with it, so that they apply to what is measured.
void KeepFromBefore(const robot::CalibrationFile& before, robot::CalibrationFile* file);

/// The same of the cameras beside the first: those that `file` does not have, by name.
void KeepCamerasFromBefore(const robot::CalibrationFile& before, robot::CalibrationFile* file);

}  // namespace palpate::calibration
