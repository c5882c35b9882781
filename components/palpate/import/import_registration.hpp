// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <ostream>

#include "components/palpate/import/import_options.hpp"
#include "libs/experiment/recording.hpp"
#include "libs/robot/robot_description.hpp"

namespace palpate::command {

/// T_robot_camera: the rigid motion that brings the markers' mean positions in the rest window (all
/// of the recording where only markers that do not move are used) nearest to the rest positions of
/// the robot file. Reports what is left for each marker. Throws InputError where the options do not
/// fit or the markers do not determine it.
Eigen::Isometry3d Register(const ImportOptions& options, const experiment::Recording& recording,
                           const robot::RobotDescription& robot, std::ostream& report);

}  // namespace palpate::command
