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

/// Whether a recording that serves has markers in the camera's frame.
bool HasMarkersOfTheCamera(const experiment::Experiment& experiment);

/// Whether a recording that serves has depth images.
bool HasImagesOfTheCamera(const experiment::Experiment& experiment);

/// Drives, gravity and the moduli of `materials` (empty: as they are) from markers, with the
/// camera's pose where they were measured in its frame (`camera`).
robot::CalibrationFile CalibrateJointly(const CalibrateOptions& options,
                                        const experiment::Experiment& experiment,
                                        const std::vector<int>& materials, bool camera,
                                        robot::RobotModel* model);

/// The same from depth and colour without markers: perception's clouds of the robot, first as it
/// sees them from the rough pose, then from the one that was found.
robot::CalibrationFile CalibrateFromImages(const CalibrateOptions& options,
                                           const experiment::Experiment& experiment,
                                           const std::vector<int>& materials,
                                           robot::RobotModel* model);

}  // namespace palpate::command
