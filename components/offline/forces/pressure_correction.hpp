// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/experiment/experiment.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::offline {

/// Pressures in the place of what the calibrated sensors read of them: the columns
/// `<chamber>.pressure_Pa` of `recording`. Call it once.
void CorrectPressures(const robot::CalibrationFile& calibration, experiment::Recording* recording);
/// The same of all its recordings.
void CorrectPressures(const robot::CalibrationFile& calibration,
                      experiment::Experiment* experiment);

}  // namespace palpate::offline
