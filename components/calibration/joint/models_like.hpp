// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <memory>
#include <vector>

#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// `count` copies of this model as it is now, with the same solver, for one thread each. Gravity is
/// that of the robot file.
std::vector<std::unique_ptr<robot::RobotModel>> ModelsLike(robot::RobotModel& model, int count);

}  // namespace palpate::calibration
