// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <memory>
#include <vector>

#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// `count` models of this one's body as it is now, with the same solver: each for a thread of its
/// own. Gravity is the robot file's.
std::vector<std::unique_ptr<robot::RobotModel>> ModelsLike(robot::RobotModel& model, int count);

}  // namespace palpate::calibration
