// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "components/virtual_camera/virtual_camera.hpp"
#include "libs/scenario/scenario_sections.hpp"

namespace palpate::virtual_camera {

/// Half a metre from a four-legged robot on a table, a wall behind; 848x480, f = 665 px, baseline
/// 55 mm, colour camera 15 mm to the right. No noise of any kind in the depth image.
scenario::Scenario QuietScenario();
/// The same with the noise that a scenario has by default.
scenario::Scenario NoisyScenario();

/// The surface of config/robots/four_leg.yaml.
const RobotSurface& FourLegSurface();

/// The robot bent over to the east, with a sphere, a cylinder, a plate and a hand around it.
View CrowdedView(const scenario::Scenario& scenario);
/// The robot at rest, no tools.
View RestingView(const scenario::Scenario& scenario);

/// Nothing but a wall across the camera's axis `distance_m` before it (the camera looks along the
/// robot frame's y axis), `tilt_rad` about its vertical axis.
struct WallBench {
  scenario::Scenario scenario;
  RobotSurface surface;
  View view;
};
WallBench FacingWall(double distance_m, double tilt_rad = 0.0);

}  // namespace palpate::virtual_camera
