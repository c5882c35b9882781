// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "components/force_estimation/marker_frame.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// Standard deviations along the robot's axes of noise given along the measurement's.
Eigen::Vector3d RotateSigma(const Eigen::Matrix3d& R_robot_measurement,
                            const Eigen::Vector3d& sigma_m);

/// Inputs of the robot's cables at `t_s`, in the robot's order. `preferred`: where a cable has
/// both.
std::vector<robot::ActuatorCommand> CablesAt(const experiment::Recording& recording,
                                             const robot::RobotModel& model,
                                             robot::CableInput preferred, double t_s);

/// The frames of a recording as MarkerForceEstimator takes them: markers in the robot's order and
/// frame, cable inputs interpolated to each frame's time, the reference window marked, with the
/// stated error of the pose. Throws InputError (file:line) for a marker or cable that the robot
/// does not have, a recording without markers, or one measured in a camera frame of unknown pose.
std::vector<MarkerFrame> FramesOfRecording(const experiment::Experiment& experiment,
                                           const experiment::Recording& recording,
                                           const robot::RobotModel& model,
                                           robot::CableInput preferred);

}  // namespace palpate::force_estimation
