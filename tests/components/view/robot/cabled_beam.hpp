// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <utility>
#include <vector>

#include "libs/robot/robot_body.hpp"
#include "tests/support/robots.hpp"

namespace palpate::view {

/// A cantilever of 12 elements with the cable `top` along its upper side.
inline robot::RobotBody CabledBeam(std::vector<robot::MarkerSettings> markers = {}) {
  robot::RobotDescription robot = test_support::QuickRobot("beam");
  robot::CableSettings cable;
  cable.name = "top";
  cable.path_m.resize(3, 2);
  cable.path_m << -0.15, 0.0, 0.015, 0.015, 0.03, 0.03;
  robot.cables = {cable};
  robot.markers = std::move(markers);
  return robot::BuildRobotBody(robot);
}

}  // namespace palpate::view
