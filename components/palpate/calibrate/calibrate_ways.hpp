// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/palpate/calibrate/calibrate_verb.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::command {

/// Young's moduli of `materials` (RobotBody::materials) from static phases with known loads.
robot::CalibrationFile CalibrateMaterial(const CalibrateOptions& options,
                                         const experiment::Experiment& experiment,
                                         const std::vector<int>& materials,
                                         robot::RobotModel* model);

/// Whether a recording lies in the camera's frame and nobody says where the camera stood.
bool NeedsCameraPose(const experiment::Experiment& experiment);

/// Camera pose and drives from markers in the camera's frame, with the moduli of `materials`
/// (empty: as they are).
robot::CalibrationFile CalibrateCamera(const CalibrateOptions& options,
                                       const experiment::Experiment& experiment,
                                       const std::vector<int>& materials, robot::RobotModel* model);

}  // namespace palpate::command
