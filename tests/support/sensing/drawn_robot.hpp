// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>

#include "components/virtual_camera/virtual_camera.hpp"
#include "libs/robot/robot_body.hpp"
#include "libs/scenario/scenario.hpp"

namespace palpate::test_support {

/// The undeformed surface of `body` with its markers.
virtual_camera::RobotSurface SkinOf(const robot::RobotBody& body);

/// A stereo camera of 848x480 pixels at `eye_m` that looks at `target_m` (robot frame), its colours
/// by a second camera of the same intrinsics in the same place; no tools.
scenario::Scenario StereoScenario(double focal_px, double baseline_m, const Eigen::Vector3d& eye_m,
                                  const Eigen::Vector3d& target_m);

/// The undeformed surface before the scenario's camera, and `tool` at `tool_m` (robot frame).
virtual_camera::View ViewWithTool(const scenario::Scenario& scenario,
                                  const virtual_camera::RobotSurface& surface,
                                  const std::string& tool, const Eigen::Vector3d& tool_m);

}  // namespace palpate::test_support
