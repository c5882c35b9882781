// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>

#include "libs/geometry/box.hpp"

namespace palpate::command {

/// From which side a virtual camera sees most of a body: sideways of its longest axis, from above
/// (`up`, unit), and a little from its free end (`to_tip_m` from what is fixed). Unit, from the
/// body to the camera.
Eigen::Vector3d ViewDirection(const Eigen::Vector3d& longest_axis, const Eigen::Vector3d& up,
                              const Eigen::Vector3d& to_tip_m);

/// T_robot_camera of the camera of StereoCameraText that sees all of `box` along `view`, level
/// (`up`), no nearer than stereo cameras measure.
Eigen::Isometry3d CameraPlace(const geometry::Box& box, const Eigen::Vector3d& view,
                              const Eigen::Vector3d& up);

/// The key `camera` of a scenario: a stereo camera of 848 x 480 pixels and 59 degrees up and down,
/// with registered colour.
std::string StereoCameraText(const Eigen::Isometry3d& T_robot_camera, double rate_hz);

}  // namespace palpate::command
