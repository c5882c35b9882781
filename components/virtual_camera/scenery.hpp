// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/virtual_camera/drawing.hpp"
#include "components/virtual_camera/virtual_camera.hpp"

namespace palpate::virtual_camera {

/// The bench as it is drawn: robot, tools, table and the wall behind.
class Scenery {
 public:
  /// Throws InputError for an inconsistent surface.
  Scenery(const scenario::Scenario& scenario, RobotSurface robot_surface);

  /// Moves robot and tools to where they are in `view`. Throws InputError for a tool that the
  /// scenario does not have.
  const Drawing& Update(const View& view);

 private:
  void AddStage(const scenario::Scenario& scenario);
  void AddRobot(const RobotSurface& robot_surface, const scenario::Stage& stage);
  void AddTool(const scenario::Tool& tool, int paint, const Eigen::Isometry3d& T_robot_tool);
  int AddPaint(const Eigen::Vector3d& rgb, kernels::Pattern pattern, double strength,
               double spot_m);

  std::vector<int> nodes_;  // those that the robot's triangles use: its vertices
  Eigen::Index node_count_ = 0;
  std::vector<scenario::Tool> tools_;
  std::vector<int> tool_paints_;
  std::size_t fixed_meshes_ = 0;  // robot and stage; tools follow
  Drawing drawing_;
};

}  // namespace palpate::virtual_camera
