// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "libs/robot/robot_body.hpp"

namespace palpate::diagnosis {

/// Two of the body's feature points: the one that is farthest from all that is held, where the body
/// yields most, and the one that is farthest from that one and from what is held; to a millimetre,
/// the accuracy of hanging a weight by hand.
std::vector<Eigen::Vector3d> PlacesToHang(const robot::RobotBody& body);

/// 30 g, or the next of 20, 10, 5, ... g that is no more than a tenth of what the body weighs: more
/// would bend it beyond what a model is linear in. 0: without gravity nothing hangs.
double MassToHang_kg(const robot::RobotBody& body);

/// Over which the weight's hook or tray spreads it, a fifteenth of the body's size.
double PatchToHang_m(const robot::RobotBody& body);

/// "at marker tip", or where on the undeformed body it is: "at (12, 0, 45) mm, 9 mm from marker
/// tip".
std::string WordsForPlace(const robot::RobotBody& body, const Eigen::Vector3d& place_m);

}  // namespace palpate::diagnosis
