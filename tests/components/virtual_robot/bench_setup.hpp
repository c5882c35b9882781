// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "components/virtual_robot/effects.hpp"
#include "components/virtual_robot/virtual_robot.hpp"
#include "libs/robot/robot_description.hpp"
#include "libs/scenario/scenario.hpp"

namespace palpate::virtual_robot::test {

/// A box from the origin to `size_m`, of `cells` bricks of six tetrahedra each, x = 0 clamped; no
/// gravity, no cables, 1000 kg/m3, E = 100 kPa, nu = 0.3, tet10, stable neo-Hookean.
robot::RobotDescription BoxRobot(const Eigen::Array3i& cells, const Eigen::Vector3d& size_m);

/// The robot file's own mesh, element and material; quasi-static.
scenario::Scenario PlainScenario();
/// The same, dynamic.
scenario::Scenario DynamicScenario(double time_step_s, double rayleigh_mass_1_s,
                                   double rayleigh_stiffness_s);

scenario::ActiveEffect Effect(const std::string& id, const std::vector<std::string>& where,
                              const std::map<std::string, double>& parameters);

/// Nothing touches or hangs; no cable is driven.
Inputs NoInputs(int cables);
Inputs Commands(const std::vector<double>& displacement_m);
scenario::HungWeight Weight(const Eigen::Vector3d& position_m, double mass_kg,
                            double patch_radius_m = 0.0);
ToolPose At(const std::string& tool, const Eigen::Vector3d& position_m);

constexpr double kNotDriven = std::numeric_limits<double>::quiet_NaN();

}  // namespace palpate::virtual_robot::test
