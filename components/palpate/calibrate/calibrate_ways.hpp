// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/calibration/joint/joint_request.hpp"
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

/// Whether nobody says which markers the points in the recordings are, or what is said is not to
/// count (--unlabelled).
bool AreUnlabelled(const CalibrateOptions& options, const experiment::Experiment& experiment);

/// As CalibrateJointly in the camera's frame, from points whose names mean nothing.
robot::CalibrationFile CalibrateFromUnlabelled(const CalibrateOptions& options,
                                               const experiment::Experiment& experiment,
                                               const std::vector<int>& materials,
                                               robot::RobotModel* model);

/// The same from the coloured markers that depth and colour show.
robot::CalibrationFile CalibrateFromFiducials(const CalibrateOptions& options,
                                              const experiment::Experiment& experiment,
                                              const std::vector<int>& materials,
                                              robot::RobotModel* model);

/// What the options ask of a joint calibration; `camera`: for the camera's pose, too.
calibration::JointRequest RequestOf(const CalibrateOptions& options,
                                    const std::vector<int>& materials, bool camera);

/// The recordings that are named, or all that serve. Throws InputError where none does.
std::vector<const experiment::Recording*> ChosenRecordings(const CalibrateOptions& options,
                                                           const experiment::Experiment& experiment,
                                                           bool camera);

}  // namespace palpate::command
