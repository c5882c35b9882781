// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/components/virtual_camera/bench.hpp"

#include <cmath>

#include "libs/robot/robot_body.hpp"
#include "libs/robot/robot_description.hpp"
#include "tests/support/robots.hpp"

namespace palpate::virtual_camera {

namespace {

scenario::CameraSpec Camera() {
  scenario::CameraSpec spec;
  spec.camera.depth = {.width_px = 848,
                       .height_px = 480,
                       .fx_px = 665.0,
                       .fy_px = 665.0,
                       .cx_px = 423.7,
                       .cy_px = 239.2};
  spec.camera.color = spec.camera.depth;
  spec.camera.color.fx_px = spec.camera.color.fy_px = 640.0;
  spec.camera.baseline_m = 0.055;
  spec.camera.T_depth_color.translation() = Eigen::Vector3d(0.015, 0.0, 0.0);
  spec.T_robot_camera = scenario::LookAt({0.12, -0.45, 0.30}, {0.0, 0.0, 0.05});
  spec.noise.sensor = scenario::DepthSensor::kNone;
  return spec;
}

scenario::Tool MakeTool(const char* name, scenario::ToolShape shape,
                        const Eigen::Vector3d& color_rgb) {
  scenario::Tool tool;
  tool.name = name;
  tool.shape = shape;
  tool.color_rgb = color_rgb;
  return tool;
}

ToolPose Pose(const char* tool, const Eigen::Vector3d& at_m, double turn_rad,
              const Eigen::Vector3d& axis) {
  ToolPose pose;
  pose.tool = tool;
  pose.T_robot_tool.linear() = Eigen::AngleAxisd(turn_rad, axis.normalized()).toRotationMatrix();
  pose.T_robot_tool.translation() = at_m;
  return pose;
}

}  // namespace

scenario::Scenario QuietScenario() {
  scenario::Scenario scenario;
  scenario.camera = Camera();
  using scenario::ToolShape;
  scenario.tools = {MakeTool("ball", ToolShape::kSphere, {0.2, 0.3, 0.8}),
                    MakeTool("rod", ToolShape::kCylinder, {0.25, 0.25, 0.27}),
                    MakeTool("plate", ToolShape::kPlate, {0.1, 0.5, 0.4}),
                    MakeTool("hand", ToolShape::kHand, {0.86, 0.63, 0.51})};
  return scenario;
}

scenario::Scenario NoisyScenario() {
  scenario::Scenario scenario = QuietScenario();
  scenario.camera->noise = {};
  return scenario;
}

const RobotSurface& FourLegSurface() {
  static const RobotSurface surface = [] {
    const robot::RobotDescription description = test_support::FourLegRobot();
    const robot::RobotBody body = robot::BuildRobotBody(description);
    RobotSurface made;
    made.rest_m = body.mesh.nodes_m;
    made.triangles = body.boundary.DrawnTriangles();
    made.markers_m.resize(3, static_cast<Eigen::Index>(description.markers.size()));
    for (std::size_t i = 0; i < description.markers.size(); ++i) {
      made.markers_m.col(static_cast<Eigen::Index>(i)) = description.markers[i].position_m;
    }
    return made;
  }();
  return surface;
}

View RestingView(const scenario::Scenario& scenario) {
  View view;
  view.nodes_m = FourLegSurface().rest_m;
  view.T_robot_camera = scenario.camera->T_robot_camera;
  return view;
}

View CrowdedView(const scenario::Scenario& scenario) {
  View view = RestingView(scenario);
  for (Eigen::Index i = 0; i < view.nodes_m.cols(); ++i) {
    const double z = view.nodes_m(2, i);
    view.nodes_m(0, i) += 1.5 * z * z;
    view.nodes_m(1, i) += 0.004 * std::sin(40.0 * z);
  }
  view.tools = {Pose("ball", {-0.05, -0.02, 0.12}, 0.0, {0.0, 0.0, 1.0}),
                Pose("rod", {0.10, -0.06, 0.06}, 1.1, {1.0, 0.3, 0.0}),
                Pose("plate", {-0.14, 0.0, 0.05}, 0.7, {0.2, 1.0, 0.4}),
                Pose("hand", {0.12, 0.05, 0.17}, 2.6, {0.1, 0.2, 1.0})};
  return view;
}

WallBench FacingWall(double distance_m, double tilt_rad) {
  WallBench bench;
  bench.scenario = NoisyScenario();
  bench.scenario.stage.table_height_m = -10.0;
  bench.scenario.stage.background_distance_m = 0.0;
  bench.scenario.camera->T_robot_camera = scenario::LookAt({0.0, -1.0, 0.0}, {0.0, 0.0, 0.0});
  const double half = 40.0;
  const Eigen::Vector3d across(std::cos(tilt_rad), std::sin(tilt_rad), 0.0);
  const Eigen::Vector3d center(0.0, distance_m - 1.0, 0.0);
  bench.surface.rest_m.resize(3, 4);
  for (int i = 0; i < 4; ++i) {
    const double a = i == 1 || i == 2 ? half : -half;
    const double b = i >= 2 ? half : -half;
    bench.surface.rest_m.col(i) = center + a * across + b * Eigen::Vector3d::UnitZ();
  }
  bench.surface.triangles.resize(3, 2);
  bench.surface.triangles << 0, 0, 1, 2, 2, 3;
  bench.surface.markers_m.resize(3, 0);
  bench.view.nodes_m = bench.surface.rest_m;
  bench.view.T_robot_camera = bench.scenario.camera->T_robot_camera;
  return bench;
}

}  // namespace palpate::virtual_camera
