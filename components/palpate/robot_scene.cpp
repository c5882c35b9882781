// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/robot_scene.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "libs/core/index.hpp"

namespace palpate::command {

namespace {

struct Bounds {
  Eigen::Vector3d lower_m;
  Eigen::Vector3d upper_m;

  Eigen::Vector3d size_m() const { return upper_m - lower_m; }
  Eigen::Vector3d center_m() const { return 0.5 * (lower_m + upper_m); }
};

Bounds BoundsOf(const Eigen::Matrix3Xd& points_m) {
  return {points_m.rowwise().minCoeff(), points_m.rowwise().maxCoeff()};
}

Eigen::Matrix3Xd FixedNodes(const robot::RobotBody& body) {
  std::vector<Eigen::Index> fixed;
  for (Eigen::Index node = 0; node < body.fixed.cols(); ++node) {
    if (body.fixed.col(node).all()) {
      fixed.push_back(node);
    }
  }
  Eigen::Matrix3Xd points_m(3, ToIndex(fixed.size()));
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    points_m.col(ToIndex(i)) = body.mesh.nodes_m.col(fixed[i]);
  }
  return points_m;
}

// A plate behind a flat clamped face; nothing for one that is not flat. A body that stands on its
// plate needs no floor below.
void AddClamp(const robot::RobotBody& body, view::Scene* scene) {
  const Eigen::Matrix3Xd fixed_m = FixedNodes(body);
  if (fixed_m.cols() == 0) {
    return;
  }
  const Bounds clamped = BoundsOf(fixed_m);
  Eigen::Index flat = 0;
  const double thickness_m = clamped.size_m().minCoeff(&flat);
  if (thickness_m > 0.02 * BodyDiagonal_m(body)) {
    return;
  }
  const bool is_ground = flat == 2;
  const double plate_m = (is_ground ? 0.025 : 0.06) * BodyDiagonal_m(body);
  const Bounds whole = BoundsOf(body.mesh.nodes_m);
  const bool at_lower_end = clamped.center_m()(flat) < whole.center_m()(flat);
  view::Block plate{clamped.center_m(), Eigen::Matrix3d::Zero()};
  plate.center_m(flat) += (at_lower_end ? -0.5 : 0.5) * plate_m;
  plate.half_axes_m.diagonal() = 0.5 * clamped.size_m() + Eigen::Vector3d::Constant(plate_m);
  plate.half_axes_m(flat, flat) = 0.5 * plate_m;
  scene->blocks.push_back(plate);
  if (is_ground && at_lower_end) {
    scene->floor_z_m.reset();
  }
}

void AddCables(const robot::RobotModel& model, const Eigen::VectorXd& x_m, view::Scene* scene) {
  for (int c = 0; c < model.CableCount(); ++c) {
    view::Tube tube;
    tube.points_m = model.cable(c).Path_m(x_m);
    scene->tubes.push_back(tube);
  }
  if (model.CableCount() > 0) {
    scene->legend.push_back({view::LegendEntry::Mark::kLine, view::palette::kCable, "cables"});
  }
}

}  // namespace

double BodyDiagonal_m(const robot::RobotBody& body) {
  return BoundsOf(body.mesh.nodes_m).size_m().norm();
}

view::Scene MakeRobotScene(const robot::RobotModel& model, const Eigen::VectorXd& x_m) {
  const robot::RobotBody& body = model.body();
  const Eigen::Map<const Eigen::Matrix3Xd> nodes_m(x_m.data(), 3, x_m.size() / 3);
  view::Scene scene;
  view::Surface surface;
  surface.points_m = nodes_m;
  surface.triangles = body.boundary.DrawnTriangles();
  surface.scalars = (nodes_m - body.mesh.nodes_m).colwise().norm().transpose();
  scene.color_bar =
      view::ColorBar{"displacement (mm)", std::max(surface.scalars.maxCoeff(), 1e-9), 1000.0};
  view::Surface rest = surface;
  rest.points_m = body.mesh.nodes_m;
  rest.scalars.resize(0);
  scene.surfaces.push_back(std::move(surface));
  scene.ghosts.push_back(std::move(rest));
  scene.legend.push_back({view::LegendEntry::Mark::kLine, view::palette::kGhost, "undeformed"});
  const double lowest_m = std::min(body.mesh.nodes_m.row(2).minCoeff(), nodes_m.row(2).minCoeff());
  scene.floor_z_m = lowest_m - 0.35 * BodyDiagonal_m(body);
  AddClamp(body, &scene);
  AddCables(model, x_m, &scene);
  return scene;
}

void AddMarkers(const Eigen::Matrix3Xd& observed_m, const Eigen::Matrix3Xd& model_m,
                view::Scene* scene) {
  view::Points observed;
  observed.points_m = observed_m;
  observed.name = "markers, measured";
  scene->points.push_back(observed);
  view::Points computed;
  computed.shape = view::Points::Shape::kCross;
  computed.points_m = model_m;
  computed.color = view::palette::kModelPoint;
  computed.name = "markers, model";
  scene->points.push_back(computed);
}

view::Scene MakeUndeformedScene(const robot::RobotModel& model) {
  const robot::RobotBody& body = model.body();
  view::Scene scene = MakeRobotScene(model, model.RestState().x_m);
  scene.title = body.name + ", undeformed";
  scene.surfaces.front().scalars.resize(0);
  scene.color_bar.reset();
  scene.ghosts.clear();
  std::erase_if(scene.legend,
                [](const view::LegendEntry& entry) { return entry.text == "undeformed"; });
  view::Points candidates;
  candidates.name = "contact candidates";
  candidates.points_m.resize(3, ToIndex(body.feature_points.size()));
  for (std::size_t k = 0; k < body.feature_points.size(); ++k) {
    candidates.points_m.col(ToIndex(k)) = body.feature_points[k].rest_m;
  }
  view::Points markers;
  markers.name = "markers";
  markers.shape = view::Points::Shape::kCross;
  markers.color = view::palette::kModelPoint;
  markers.points_m.resize(3, ToIndex(body.markers.size()));
  for (std::size_t k = 0; k < body.markers.size(); ++k) {
    markers.points_m.col(ToIndex(k)) = body.markers[k].point.rest_m;
  }
  for (view::Points* points : {&candidates, &markers}) {
    if (points->points_m.cols() > 0) scene.points.push_back(std::move(*points));
  }
  scene.caption = {std::to_string(body.feature_points.size()) + " contact candidates"};
  return scene;
}

void AddForce(const Eigen::Vector3d& at_m, const Eigen::Vector3d& force_N, double metres_per_newton,
              const view::Color& color, const std::string& label, view::Scene* scene) {
  view::Arrow arrow;
  arrow.from_m = at_m;
  arrow.vector_m = metres_per_newton * force_N;
  arrow.color = color;
  arrow.label = label;
  scene->arrows.push_back(arrow);
}

}  // namespace palpate::command
