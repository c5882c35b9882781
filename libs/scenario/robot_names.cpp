// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/scenario/robot_names.hpp"

namespace palpate::scenario {

RobotNames NamesOf(const robot::RobotDescription& robot) {
  RobotNames names;
  for (const auto& cable : robot.cables) names.cables.push_back(cable.name);
  for (const auto& chamber : robot.chambers) names.chambers.push_back(chamber.name);
  for (const auto& region : robot.regions) names.regions.push_back(region.name);
  for (const auto& marker : robot.markers) names.markers.push_back(marker.name);
  names.poissons_ratio = robot.material.poissons_ratio;
  return names;
}

}  // namespace palpate::scenario
