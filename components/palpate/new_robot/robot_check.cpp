// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/new_robot/robot_check.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "components/palpate/new_robot/unit_guess.hpp"
#include "components/palpate/robot_scene.hpp"
#include "libs/core/clock.hpp"
#include "libs/core/index.hpp"

namespace palpate::command {

namespace {

using robot::ActuatorCommand;

Eigen::Index TipOf(const robot::RobotBody& body) {
  Eigen::Vector3d fixed_m = Eigen::Vector3d::Zero();
  int count = 0;
  for (Eigen::Index node = 0; node < body.fixed.cols(); ++node) {
    if (!body.fixed.col(node).all()) continue;
    fixed_m += body.mesh.nodes_m.col(node);
    ++count;
  }
  fixed_m /= std::max(count, 1);
  double farthest_m = -1.0;
  Eigen::Index tip = 0;
  for (const int node : body.mesh.cells.reshaped()) {
    const double distance_m = (body.mesh.nodes_m.col(node) - fixed_m).norm();
    if (distance_m <= farthest_m) continue;
    farthest_m = distance_m;
    tip = node;
  }
  return tip;
}

Eigen::Map<const Eigen::Matrix3Xd> Nodes(const Eigen::VectorXd& x_m) {
  return {x_m.data(), 3, x_m.size() / 3};
}

PullTrial Pull(int cable, double pull_m, Eigen::Index tip, const fem::StaticState& rest,
               robot::RobotModel* model) {
  PullTrial trial{.cable = model->body().cables[At(cable)].name, .status = {}, .pull_m = pull_m};
  std::vector<ActuatorCommand> commands(At(model->ActuatorCount()));
  const double at_rest_m = model->StateOfActuator(cable, rest).displacement_m;
  commands[At(cable)] = {ActuatorCommand::Kind::kDisplacement, at_rest_m + pull_m};
  fem::StaticState state = rest;
  trial.status = model->Solve(commands, {}, &state).status;
  if (!trial.status.ok()) return trial;
  trial.tension_N = model->StateOfActuator(cable, state).tension_N;
  const Eigen::Matrix3Xd motion_m = Nodes(state.x_m) - Nodes(rest.x_m);
  trial.tip_motion_m = motion_m.col(tip);
  trial.largest_motion_m = motion_m.colwise().norm().maxCoeff();
  return trial;
}

void WarnOfPull(const PullTrial& trial, std::vector<std::string>* warnings) {
  constexpr double kNothing = 0.05;
  if (!trial.status.ok()) {
    warnings->push_back(fmt::format(
        "cable {}: no equilibrium with {} pulled in: {}. Is its route meant so? A cable between "
        "fixed points cannot be shortened",
        trial.cable, LengthText(trial.pull_m), trial.status.message()));
  } else if (trial.largest_motion_m < kNothing * trial.pull_m || trial.tension_N <= 0.0) {
    warnings->push_back(fmt::format(
        "cable {} does nothing: {} pulled in move the body by {} at most; check its route",
        trial.cable, LengthText(trial.pull_m), LengthText(trial.largest_motion_m)));
  }
}

void WarnOfTime(const robot::RobotBody& body, double most_s, RobotCheck* check) {
  if (!check->cut_short) return;
  check->warnings.push_back(
      fmt::format("{} of {} cables were tried in {:.0f} s: the mesh has {} nodes with 10-node "
                  "elements. palpate solve tries them all; a coarser mesh is faster",
                  check->pulls.size(), body.cables.size(), most_s, body.mesh.NodeCount()));
}

void WarnOfSag(double diagonal_m, RobotCheck* check) {
  constexpr double kFar = 0.25;
  if (check->cut_short && !check->rest.ok()) return;
  if (!check->rest.ok()) {
    check->warnings.push_back("no equilibrium under gravity: " + check->rest.message() +
                              ". Check unit, material and what is fixed");
  } else if (check->sag_m > kFar * diagonal_m) {
    check->warnings.push_back(
        fmt::format("under gravity the body sags by {}, which is much of its {}: check unit, "
                    "material, up and what is fixed",
                    LengthText(check->sag_m), LengthText(diagonal_m)));
  }
}

}  // namespace

bool RobotCheck::ok() const {
  return (rest.ok() || cut_short) && std::all_of(pulls.begin(), pulls.end(), [](const auto& trial) {
           return trial.status.ok();
         });
}

double TrialPull_m(const robot::RobotBody& body) { return 0.01 * BodyDiagonal_m(body); }

RobotCheck CheckRobot(robot::RobotModel* model, double most_s) {
  RobotCheck check;
  const robot::RobotBody& body = model->body();
  const Eigen::Index tip = TipOf(body);
  check.tip_m = body.mesh.nodes_m.col(tip);
  const std::int64_t start_ns = MonotonicNow_ns();
  const auto elapsed_s = [&] { return 1e-9 * static_cast<double>(MonotonicNow_ns() - start_ns); };
  model->static_solver().SetObserver([&](const fem::StaticResult&) {
    check.cut_short = check.cut_short || elapsed_s() > most_s;
    return !check.cut_short;
  });
  fem::StaticState rest = model->RestState();
  const std::vector<ActuatorCommand> no_commands(At(model->ActuatorCount()));
  check.rest = model->Solve(no_commands, {}, &rest).status;
  int solved = 1;
  if (check.rest.ok()) {
    check.sag_m = (Nodes(rest.x_m) - body.mesh.nodes_m).colwise().norm().maxCoeff();
    for (int cable = 0; cable < model->ActuatorCount() && !check.cut_short; ++cable, ++solved) {
      PullTrial trial = Pull(cable, TrialPull_m(body), tip, rest, model);
      if (!check.cut_short) check.pulls.push_back(std::move(trial));
    }
  }
  model->static_solver().SetObserver({});
  check.solve_s = elapsed_s() / solved;
  WarnOfTime(body, most_s, &check);
  WarnOfSag(BodyDiagonal_m(body), &check);
  for (const PullTrial& trial : check.pulls) WarnOfPull(trial, &check.warnings);
  return check;
}

}  // namespace palpate::command
