// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/support/sensing/drawn_robot.hpp"

#include "libs/scenario/scenario_sections.hpp"

namespace palpate::test_support {

virtual_camera::RobotSurface SkinOf(const robot::RobotBody& body) {
  virtual_camera::RobotSurface surface;
  surface.rest_m = body.mesh.nodes_m;
  surface.triangles = body.boundary.DrawnTriangles();
  surface.markers_m.resize(3, static_cast<Eigen::Index>(body.markers.size()));
  for (std::size_t i = 0; i < body.markers.size(); ++i) {
    surface.markers_m.col(static_cast<Eigen::Index>(i)) = body.markers[i].point.rest_m;
  }
  return surface;
}

scenario::Scenario StereoScenario(double focal_px, double baseline_m, const Eigen::Vector3d& eye_m,
                                  const Eigen::Vector3d& target_m) {
  scenario::Scenario scenario;
  scenario::CameraSpec& spec = scenario.camera.emplace();
  spec.camera.depth = {.width_px = 848,
                       .height_px = 480,
                       .fx_px = focal_px,
                       .fy_px = focal_px,
                       .cx_px = 423.5,
                       .cy_px = 239.5};
  spec.camera.baseline_m = baseline_m;
  spec.camera.color = spec.camera.depth;
  spec.T_robot_camera = scenario::LookAt(eye_m, target_m);
  return scenario;
}

virtual_camera::View ViewWithTool(const scenario::Scenario& scenario,
                                  const virtual_camera::RobotSurface& surface,
                                  const std::string& tool, const Eigen::Vector3d& tool_m) {
  virtual_camera::View view;
  view.nodes_m = surface.rest_m;
  view.T_robot_camera = scenario.camera->T_robot_camera;
  view.tools.push_back({tool, Eigen::Isometry3d::Identity()});
  view.tools[0].T_robot_tool.translation() = tool_m;
  return view;
}

}  // namespace palpate::test_support
