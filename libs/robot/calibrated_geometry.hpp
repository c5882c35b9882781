// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "libs/core/config_node.hpp"
#include "libs/core/key_table.hpp"
#include "libs/core/status.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::robot {

/// Range of a calibrated scale; beyond it the robot file is of another robot.
inline constexpr double kSmallestScale = 0.5;
inline constexpr double kLargestScale = 2.0;
/// Largest calibrated offset of a point of a cable's route along any axis.
inline constexpr double kFarthestOff_m = 0.05;

/// Size of the robot over that in its file, pull points included, about the origin of the robot
/// frame, at the density of the file.
struct CalibratedScale {
  double scale = 1.0;
  double standard_error = 0.0;
};

/// Offset of a point of a cable's route from its place in the robot file: the pull point, or an
/// eyelet on the body; robot frame, for a robot of scale 1. The data hardly determine it along the
/// cable.
struct CalibratedRoute {
  std::string cable;
  int point = 0;  ///< of path_m in the robot file; 0: the pull point
  Eigen::Vector3d moved_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d standard_error_m = Eigen::Vector3d::Zero();
};

/// The keys of `geometry_scale`, and of an item of `cable_routes`.
const KeyTable& GeometryScaleKeys();
const KeyTable& CableRouteKeys();

/// Read the map strictly; throw InputError with file:line:column.
CalibratedScale ReadGeometryScale(const ConfigNode& node);
CalibratedRoute ReadCableRoute(const ConfigNode& node);
/// As ReadGeometryScale and ReadCableRoute read it: the keys `geometry_scale` and `cable_routes`
/// of what there is.
std::string FormatGeometry(const std::optional<CalibratedScale>& scale,
                           const std::vector<CalibratedRoute>& routes);

/// kInvalidInput: numbers that are not finite, a scale or a point's way out of bounds, standard
/// errors or points below 0.
Status CheckGeometry(const std::optional<CalibratedScale>& scale,
                     const std::vector<CalibratedRoute>& routes);

/// Makes a body of the robot file's size `scale` times as large (RobotBody::scale): nodes, guides,
/// masses at the same density. Limits of tensions stay.
void ScaleBody(double scale, RobotBody* body);

}  // namespace palpate::robot
