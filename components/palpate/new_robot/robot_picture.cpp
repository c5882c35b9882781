// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/new_robot/robot_picture.hpp"

#include <fmt/core.h>

#include <utility>

#include "components/palpate/robot_scene.hpp"
#include "components/view/picture/color.hpp"

namespace palpate::command {

view::Scene NewRobotScene(const RobotDraft& draft, const robot::RobotModel& model) {
  view::Scene scene = MakeUndeformedScene(model);
  scene.title = draft.description.name;
  std::erase_if(scene.points,
                [](const view::Points& points) { return points.name == "contact candidates"; });
  scene.caption = {
      fmt::format("fixed: {} ({})", draft.fixed.decision.value,
                  ToString(draft.fixed.decision.trust)),
      fmt::format("{} is up; the mesh is in {}", draft.Of("up").value, draft.Of("unit").value)};
  view::Points fixed;
  fixed.points_m = draft.shape.mesh.nodes_m(Eigen::all, draft.fixed.nodes);
  fixed.radius_m = 0.004 * draft.shape.diagonal_m;
  fixed.color = view::palette::kAxisX;
  fixed.name = "fixed nodes";
  scene.points.push_back(std::move(fixed));
  for (view::Tube& tube : scene.tubes) tube.radius_m = 0.004 * draft.shape.diagonal_m;
  for (const CableRoute& route : draft.cables) {
    const Eigen::Vector3d pull_m = route.path_m.col(0);
    const Eigen::Vector3d along = (pull_m - route.path_m.col(1)).normalized();
    AddForce(pull_m, along, 0.08 * draft.shape.diagonal_m, view::palette::kCable, route.name,
             &scene);
  }
  return scene;
}

}  // namespace palpate::command
