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

/// Whether a suitable recording has markers in the camera's frame.
bool HasMarkersOfTheCamera(const experiment::Experiment& experiment);

/// Whether a suitable recording has depth images.
bool HasImagesOfTheCamera(const experiment::Experiment& experiment);

/// Actuator offsets, gravity and the moduli of `materials` (empty: not estimated) from markers,
/// with the camera pose where they were measured in its frame.
robot::CalibrationFile CalibrateJointly(const CalibrateOptions& options,
                                        const experiment::Experiment& experiment,
                                        const std::vector<int>& materials,
                                        robot::RobotModel* model);

/// The same from depth and colour without markers: from the robot's point clouds, segmented first
/// with the approximate pose, then with the estimated one.
robot::CalibrationFile CalibrateFromImages(const CalibrateOptions& options,
                                           const experiment::Experiment& experiment,
                                           const std::vector<int>& materials,
                                           robot::RobotModel* model);

/// Whether the points of the recordings have no marker names, or --unlabelled ignores them.
bool AreUnlabelled(const CalibrateOptions& options, const experiment::Experiment& experiment);

/// As CalibrateJointly in the camera's frame, from points without names.
robot::CalibrationFile CalibrateFromUnlabelled(const CalibrateOptions& options,
                                               const experiment::Experiment& experiment,
                                               const std::vector<int>& materials,
                                               robot::RobotModel* model);

/// The same from the fiducials that depth and colour images show.
robot::CalibrationFile CalibrateFromFiducials(const CalibrateOptions& options,
                                              const experiment::Experiment& experiment,
                                              const std::vector<int>& materials,
                                              robot::RobotModel* model);

/// The parameters and priors of a joint calibration; `camera`: with the camera pose.
calibration::JointRequest RequestOf(const CalibrateOptions& options,
                                    const experiment::Experiment& experiment,
                                    const std::vector<int>& materials, bool camera);

/// The recordings that are named, or all that are suitable: for `camera` those that it sees.
/// Throws InputError where none is.
std::vector<const experiment::Recording*> ChosenRecordings(const CalibrateOptions& options,
                                                           const experiment::Experiment& experiment,
                                                           bool camera);

}  // namespace palpate::command
