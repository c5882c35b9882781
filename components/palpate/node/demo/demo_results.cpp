// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/demo/demo_results.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "components/palpate/find_robot.hpp"
#include "components/palpate/robot_scene.hpp"
#include "components/view/plot/force_plot.hpp"

namespace palpate::command {

namespace {

// Relative to the body's diagonal: length of the longest arrow, offset of the truth.
constexpr double kLongestArrow = 0.45;
constexpr double kAside = 0.05;

double Largest_N(const ForceFrame& frame) {
  double largest_N = 1e-6;
  for (const ComparedForce& force : frame.forces) {
    if (force.truth) largest_N = std::max(largest_N, force.truth->force_N.norm());
    if (force.estimate) largest_N = std::max(largest_N, force.estimate->force_N.norm());
  }
  return largest_N;
}

// At right angles to the force and level, so that equal arrows do not hide each other.
Eigen::Vector3d Aside(const Eigen::Vector3d& force_N) {
  const Eigen::Vector3d level = force_N.cross(Eigen::Vector3d::UnitZ());
  return level.norm() > 0.1 * force_N.norm() ? level.normalized() : Eigen::Vector3d::UnitY();
}

// A force that pushes: the arrow's head is where it acts.
void AddPush(const Eigen::Vector3d& at_m, const Eigen::Vector3d& vector_m, const view::Color& color,
             const std::string& label, view::Scene* scene) {
  scene->arrows.push_back(
      {.from_m = at_m, .vector_m = vector_m, .points_at = true, .color = color, .label = label});
}

}  // namespace

view::Scene MakeForceScene(const robot::RobotModel& model, const ForceFrame& frame,
                           const std::string& title) {
  view::Scene scene = MakeRobotScene(model, frame.nodes_m);
  const double diagonal_m = BodyDiagonal_m(model.body());
  const double metres_per_newton = kLongestArrow * diagonal_m / Largest_N(frame);
  bool has_truth = false;
  for (const ComparedForce& force : frame.forces) {
    if (force.estimate) {
      const auto& estimate = *force.estimate;
      AddPush(estimate.position_m, metres_per_newton * estimate.force_N, view::palette::kEstimate,
              fmt::format("{:.2f} ± {:.2f} N", estimate.force_N.norm(), estimate.ci95_N), &scene);
    }
    if (force.truth) {
      const TrueContact& truth = *force.truth;
      AddPush(truth.position_m + kAside * diagonal_m * Aside(truth.force_N),
              metres_per_newton * truth.force_N, view::palette::kTruth,
              fmt::format("{:.2f} N true", truth.force_N.norm()), &scene);
      has_truth = true;
    }
  }
  scene.title = title;
  scene.caption = {fmt::format(
      "{:.1f} s after the start; shape: the model fitted to the depth images", frame.t_s)};
  using Mark = view::LegendEntry::Mark;
  scene.legend.push_back({Mark::kLine, view::palette::kEstimate, "force estimated (95 %)"});
  if (has_truth)
    scene.legend.push_back({Mark::kLine, view::palette::kTruth, "true force (drawn beside)"});
  return scene;
}

void WriteDemoResults(const std::filesystem::path& folder, const std::filesystem::path& robot,
                      const std::string& title, const LiveComparison& comparison) {
  view::SaveTimePlot(folder / "forces.svg", view::MakeForcePlot(title, comparison.Tracks()));
  fmt::print("  {:<18} {}\n", "plot", (folder / "forces.svg").string());
  if (!comparison.best()) return;
  const auto model = LoadRobot(robot);
  if (comparison.best()->nodes_m.size() != model->body().mesh.nodes_m.size()) {
    fmt::print("  no image: /robot/mesh_state belongs to another mesh\n");
    return;
  }
  view::SaveScene(folder / "scene.png", MakeForceScene(*model, *comparison.best(), title));
  fmt::print("  {:<18} {}\n", "image", (folder / "scene.png").string());
}

void TellRecording(const std::filesystem::path& recording, const std::filesystem::path& robot) {
  std::error_code none;
  if (!std::filesystem::exists(recording, none)) return;
  fmt::print("  {:<18} {}\n  Look at it again in a browser: palpate view {} --robot {}\n",
             "recording", recording.string(), recording.string(), robot.string());
}

}  // namespace palpate::command
