// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <array>
#include <string>

#include "components/calibration/joint/unknowns.hpp"

/// Where the points of a cable's path sit: the guide that it is pulled from (point 0) and its
/// eyelets on the body (from 1 on), as unknowns of a calibration.
namespace palpate::calibration {

/// Two directions square to each other and across the path from the point before to the one after
/// (the first and the last one have one neighbour), near TiltAxes of it. Of places in the robot
/// file, wherever the points are now.
std::array<TiltAxis, 2> AcrossCable(const robot::RobotBody& body, int cable, int point);

/// Name of RouteOf: "cable_route:north:x" of the guide, "cable_eyelet:north:1:x" of an eyelet.
std::string RouteName(const std::string& cable_name, int point, const std::string& axis_name);

/// m: how far a point of a cable's path sits off its place in the robot file along `direction`, of
/// AcrossCable: along the cable nothing, or little, shows of it. Of a robot of scale 1. Drives
/// count from the undeformed body with the point where it is. An eyelet needs a body with room
/// (robot/eyelets.hpp).
UnknownPtr RouteOf(const robot::RobotBody& body, int cable, int point, const TiltAxis& direction,
                   const Belief& belief);

}  // namespace palpate::calibration
