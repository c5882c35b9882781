// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "components/palpate/touches/touch_plan.hpp"

namespace palpate::command {

/// Half a minute of touches on a robot as the text of a scenario: rest, a contact in view, one out
/// of view, two at once, and one while the actuators hold a posture. What the plan does not have is
/// left out. The virtual robot has the mesh of the robot file, at 30 Hz, at 10 Hz where it is fine.
std::string TouchScenario(const robot::RobotBody& body, const TouchPlan& plan);

}  // namespace palpate::command
