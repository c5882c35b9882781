// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_camera/scenery.hpp"

#include <algorithm>
#include <cmath>

#include "components/virtual_camera/hand.hpp"
#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"

namespace palpate::virtual_camera {

namespace {

constexpr double kTableThickness_m = 0.03;
constexpr double kWallWidth_m = 4.0;
constexpr double kWallHeight_m = 3.0;

// A lamp above and to the side, a weaker one on the other side, and bright walls.
Lighting LightOf(const scenario::Stage& stage) {
  Lighting lighting;
  lighting.ambient = 0.40 * stage.light;
  lighting.to_lamp.col(0) = Eigen::Vector3d(0.45, -0.55, 1.0).normalized();
  lighting.to_lamp.col(1) = Eigen::Vector3d(-0.8, -0.5, 0.5).normalized();
  lighting.intensity = Eigen::Vector2d(0.55, 0.22) * stage.light;
  return lighting;
}

// Where a colour stands on the circle of hues, [0, 6): red 0, green 2, blue 4; grey counts as red.
double HueOf(const Eigen::Vector3d& rgb) {
  Eigen::Index most = 0;
  const double range = rgb.maxCoeff(&most) - rgb.minCoeff();
  if (range <= 0.0) return 0.0;
  const double next = rgb[(most + 1) % 3];
  const double after = rgb[(most + 2) % 3];
  return std::fmod(2.0 * static_cast<double>(most) + (next - after) / range + 6.0, 6.0);
}

// Fully saturated colour of marker `index`: hues as far apart as `count` allows, and at least a
// twelfth of the circle from the robot's.
Eigen::Vector3d MarkerColor(int index, int count, double robot_hue) {
  const double hue = robot_hue + 0.5 + 5.0 * (index + 0.5) / count;
  const auto channel = [hue](double peak) {
    return std::clamp(2.0 - std::abs(std::remainder(hue - peak, 6.0)), 0.0, 1.0);
  };
  return {channel(0.0), channel(2.0), channel(4.0)};
}

void CopyColor(const Eigen::Vector3d& rgb, float* to) {
  for (int k = 0; k < 3; ++k) to[k] = static_cast<float>(rgb[k]);
}

// The discs that a triangle of the rest shape may carry.
std::vector<int> DiscsNear(const RobotSurface& robot_surface, Eigen::Index triangle,
                           double radius_m) {
  Eigen::Matrix3d corners;
  for (int k = 0; k < 3; ++k)
    corners.col(k) = robot_surface.rest_m.col(robot_surface.triangles(k, triangle));
  const Eigen::Vector3d center = corners.rowwise().mean();
  const double reach = (corners.colwise() - center).colwise().norm().maxCoeff();
  std::vector<int> near;
  for (Eigen::Index marker = 0; marker < robot_surface.markers_m.cols(); ++marker) {
    // A pixel's width for the soft rim.
    const double limit = reach + 1.5 * radius_m;
    if ((robot_surface.markers_m.col(marker) - center).norm() <= limit) {
      near.push_back(static_cast<int>(marker));
    }
  }
  return near;
}

void CheckSurface(const RobotSurface& robot_surface) {
  const bool fits = robot_surface.triangles.size() == 0 ||
                    (robot_surface.triangles.minCoeff() >= 0 &&
                     robot_surface.triangles.maxCoeff() < robot_surface.rest_m.cols());
  if (!fits) throw InputError("the surface's triangles name nodes that it does not have");
  if (!robot_surface.rest_m.allFinite() || !robot_surface.markers_m.allFinite()) {
    throw InputError("the surface has positions that are not numbers");
  }
}

// The nodes that triangles use, rising.
std::vector<int> UsedNodes(const Eigen::Matrix3Xi& triangles) {
  std::vector<int> nodes(triangles.data(), triangles.data() + triangles.size());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

// Horizontal, from the robot's axis away from the camera; zero where the camera is above.
Eigen::Vector3d AwayFrom(const Eigen::Isometry3d& T_robot_camera) {
  Eigen::Vector3d away = -T_robot_camera.translation();
  away.z() = 0.0;
  const double length = away.norm();
  return length > 1e-3 ? Eigen::Vector3d(away / length) : Eigen::Vector3d::Zero();
}

}  // namespace

Scenery::Scenery(const scenario::Scenario& scenario, RobotSurface robot_surface)
    : tools_(scenario.tools) {
  CheckSurface(robot_surface);
  drawing_.lighting = LightOf(scenario.stage);
  AddRobot(robot_surface, scenario.stage);
  AddStage(scenario);
  for (const scenario::Tool& tool : tools_) {
    tool_paints_.push_back(AddPaint(tool.color_rgb, kernels::Pattern::kPlain, 0.0, 1.0));
  }
  fixed_meshes_ = drawing_.meshes.size();
}

int Scenery::AddPaint(const Eigen::Vector3d& rgb, kernels::Pattern pattern, double strength,
                      double spot_m) {
  kernels::Paint& paint = drawing_.paints.emplace_back();
  CopyColor(rgb, paint.rgb);
  paint.pattern = pattern;
  paint.strength = static_cast<float>(strength);
  paint.frequency_m = static_cast<float>(1.0 / spot_m);
  return static_cast<int>(drawing_.paints.size()) - 1;
}

void Scenery::AddRobot(const RobotSurface& robot_surface, const scenario::Stage& stage) {
  DrawnMesh& robot = drawing_.meshes.emplace_back();
  robot.paint = AddPaint(stage.robot_color_rgb, kernels::Pattern::kSolid, 0.22, 0.006);
  nodes_ = UsedNodes(robot_surface.triangles);
  node_count_ = robot_surface.rest_m.cols();
  robot.vertices_m = robot_surface.rest_m(Eigen::all, nodes_);
  robot.texture_m = robot.vertices_m;
  robot.triangles = robot_surface.triangles.unaryExpr([this](int node) {
    return static_cast<int>(std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin());
  });
  LightSmoothly(drawing_.lighting, &robot);
  if (stage.marker_radius_m <= 0.0) return;
  const int markers = static_cast<int>(robot_surface.markers_m.cols());
  for (int i = 0; i < markers; ++i) {
    kernels::Disc& disc = drawing_.discs.emplace_back();
    CopyColor(robot_surface.markers_m.col(i), disc.center_m);
    disc.radius_m = static_cast<float>(stage.marker_radius_m);
    const double robot_hue = HueOf(stage.robot_color_rgb);
    CopyColor(stage.marker_color_rgb.value_or(MarkerColor(i, markers, robot_hue)), disc.rgb);
  }
  robot.disc_begin.push_back(0);
  for (Eigen::Index t = 0; t < robot_surface.triangles.cols(); ++t) {
    const std::vector<int> near = DiscsNear(robot_surface, t, stage.marker_radius_m);
    robot.disc_list.insert(robot.disc_list.end(), near.begin(), near.end());
    robot.disc_begin.push_back(static_cast<int>(robot.disc_list.size()));
  }
}

void Scenery::AddStage(const scenario::Scenario& scenario) {
  const scenario::Stage& stage = scenario.stage;
  const int table = AddPaint(stage.table_color_rgb, kernels::Pattern::kSurface, 0.06, 0.01);
  Eigen::Isometry3d T_robot_table = Eigen::Isometry3d::Identity();
  T_robot_table.translation().z() = stage.table_height_m - 0.5 * kTableThickness_m;
  drawing_.meshes.push_back(
      MakeBox(T_robot_table, {stage.table_size_m.x(), stage.table_size_m.y(), kTableThickness_m},
              table, false, drawing_.lighting));
  const Eigen::Vector3d away = AwayFrom(scenario.camera->T_robot_camera);
  if (stage.background_distance_m <= 0.0 || away.isZero()) return;
  const int wall = AddPaint(stage.background_color_rgb, kernels::Pattern::kPlain, 0.0, 1.0);
  Eigen::Isometry3d T_robot_wall = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  T_robot_wall.linear() << away, up.cross(away), up;
  const double thickness = 0.1;
  T_robot_wall.translation() = (stage.background_distance_m + 0.5 * thickness) * away;
  drawing_.meshes.push_back(MakeBox(T_robot_wall, {thickness, kWallWidth_m, kWallHeight_m}, wall,
                                    false, drawing_.lighting));
}

void Scenery::AddTool(const scenario::Tool& tool, int paint,
                      const Eigen::Isometry3d& T_robot_tool) {
  switch (tool.shape) {
    case scenario::ToolShape::kSphere:
      drawing_.rounds.push_back({tool.radius_m, 0.0, true, T_robot_tool, paint});
      return;
    case scenario::ToolShape::kCylinder:
      drawing_.rounds.push_back({tool.radius_m, 0.5 * tool.length_m, false, T_robot_tool, paint});
      return;
    case scenario::ToolShape::kPlate:
      drawing_.meshes.push_back(MakeBox(T_robot_tool, tool.size_m, paint, true, drawing_.lighting));
      return;
    case scenario::ToolShape::kHand: {
      const std::vector<DrawnRound> hand = MakeHand(T_robot_tool, paint);
      drawing_.rounds.insert(drawing_.rounds.end(), hand.begin(), hand.end());
      return;
    }
  }
}

const Drawing& Scenery::Update(const View& view) {
  DrawnMesh& robot = drawing_.meshes.front();
  PALPATE_CHECK(view.nodes_m.cols() == node_count_, view.nodes_m.cols(), node_count_);
  robot.vertices_m = view.nodes_m(Eigen::all, nodes_);
  LightSmoothly(drawing_.lighting, &robot);
  drawing_.meshes.resize(fixed_meshes_);
  drawing_.rounds.clear();
  for (const ToolPose& pose : view.tools) {
    const auto tool = std::find_if(tools_.begin(), tools_.end(),
                                   [&pose](const auto& one) { return one.name == pose.tool; });
    if (tool == tools_.end()) throw InputError("the scenario has no tool '" + pose.tool + "'");
    AddTool(*tool, tool_paints_[At(tool - tools_.begin())], pose.T_robot_tool);
  }
  return drawing_;
}

}  // namespace palpate::virtual_camera
