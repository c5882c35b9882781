// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "libs/experiment/experiment.hpp"

namespace palpate::experiment {

/// The marker tracks of a recording. Throws InputError where it has no markers.csv.
const MarkerTracks& RequireMarkers(const Recording& recording);

/// T_robot_measurement (RobotFromMarkers). Throws InputError where the camera pose is
/// unknown.
Eigen::Isometry3d RequireRobotFromMarkers(const Experiment& experiment, const Recording& recording);

/// The input of an actuator at time `t_s` (Actuation::ValueAt), in the unit of its column; nullopt
/// where the recording has no such column.
std::optional<double> ActuatorInputAt(const Recording& recording, const std::string& cable,
                                      ActuatorQuantity quantity, double t_s);

}  // namespace palpate::experiment
