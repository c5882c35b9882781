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

/// The input of a cable at time `t_s` (Actuation::ValueAt), m or N; nullopt where the recording has
/// no such column.
std::optional<double> CableInputAt(const Recording& recording, const std::string& cable,
                                   CableQuantity quantity, double t_s);

}  // namespace palpate::experiment
