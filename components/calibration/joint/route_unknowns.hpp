// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <array>
#include <string>

#include "components/calibration/joint/unknowns.hpp"

/// Points of a cable's route as unknowns: the point that it is pulled from (point 0) and its
/// eyelets on the body (from 1 on).
namespace palpate::calibration {

/// Two orthogonal directions across the route from the point before to the one after (the first and
/// the last point have one neighbour), near TiltAxes of it. They refer to the robot file, not to
/// the present places.
std::array<TiltAxis, 2> AcrossCable(const robot::RobotBody& body, int cable, int point);

/// Name of RouteOf: "cable_route:north:x" of point 0, "cable_eyelet:north:1:x" of an eyelet.
std::string RouteName(const std::string& cable_name, int point, const std::string& axis_name);

/// m: offset of a point of a cable's route from the robot file along `direction` of AcrossCable. An
/// offset along the cable is hardly observable. Of a robot of scale 1. Displacements of the
/// actuator count from the undeformed body with this offset. An eyelet needs a body with room
/// (robot/eyelets.hpp).
UnknownPtr RouteOf(const robot::RobotBody& body, int cable, int point, const TiltAxis& direction,
                   const GaussianPrior& prior);

}  // namespace palpate::calibration
