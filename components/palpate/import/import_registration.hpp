// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <ostream>

#include "components/palpate/import/import_options.hpp"
#include "libs/experiment/recording.hpp"
#include "libs/robot/robot_description.hpp"

namespace palpate::command {

/// T_robot_camera: rigid registration of the markers' mean positions in the rest window (in the
/// whole recording where only markers that do not move are used) to the rest positions of the robot
/// file. Reports the residual of each marker. Throws InputError where the options contradict each
/// other or the markers do not determine the pose.
Eigen::Isometry3d Register(const ImportOptions& options, const experiment::Recording& recording,
                           const robot::RobotDescription& robot, std::ostream& report);

}  // namespace palpate::command
