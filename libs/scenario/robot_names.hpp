// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/robot/robot_description.hpp"
#include "libs/scenario/scenario.hpp"

namespace palpate::scenario {

/// What a scenario has to know of this robot.
RobotNames NamesOf(const robot::RobotDescription& robot);

}  // namespace palpate::scenario
