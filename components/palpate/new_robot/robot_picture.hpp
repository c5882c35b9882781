// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/palpate/new_robot/robot_draft.hpp"
#include "components/view/picture/scene.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::command {

/// The undeformed robot, what is fixed, its markers, and its cables with their names at the points
/// that pull them.
view::Scene NewRobotScene(const RobotDraft& draft, const robot::RobotModel& model);

}  // namespace palpate::command
