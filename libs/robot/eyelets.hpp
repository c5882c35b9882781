// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "libs/fem/embedding.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::robot {

/// Offset of an eyelet (0: next to the actuator) from its place in the robot file, m, for scale 1.
Eigen::Vector3d EyeletMoved_m(const BodyCable& cable, int eyelet);
/// Where the robot file has it, of a robot of that scale.
Eigen::Vector3d EyeletPlace_m(const BodyCable& cable, double scale, int eyelet);

/// Displaces an eyelet by `moved_m` and locates its element again. `scale`: RobotBody::scale.
void MoveEyelet(const fem::PointLocator& locator, double scale, int eyelet,
                const Eigen::Vector3d& moved_m, BodyCable* cable);

/// Lets a model of this body move every eyelet by up to `reach_m` along each axis from where it is
/// now (RobotModel::MoveEyelet): it holds on to all nodes that it might come to, with weight 0. The
/// stiffness matrix has an entry for each pair of them, zero or not. Outside of the body, where an
/// eyelet holds on to the element of the nearest centroid, an element may be missed.
void GiveEyeletsRoom(double reach_m, RobotBody* body);

}  // namespace palpate::robot
