// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/sensing_scene.hpp"

#include <string>

#include "libs/core/error.hpp"

namespace palpate::benchmarks {

namespace {

constexpr int kSteps = 4;
constexpr double kCableAtRest_m = 5e-3;
/// A frame in which one linearisation is enough moves less than one that is to converge.
double CableStep_m(SensingScene::Update update) {
  return update == SensingScene::Update::kOneStep ? 0.05e-3 : 1e-3;
}
constexpr double kPatchRadius_m = 5e-3;
constexpr double kMarkerSigma_m = 1e-4;

robot::RobotBody MakeBody(robot::RobotDescription description, int feature_points) {
  description.feature_points_m.resize(3, 0);
  description.feature_point_count = feature_points;
  robot::RobotBody body = robot::BuildRobotBody(description);
  body.markers.clear();
  for (size_t k = 0; k < body.feature_points.size(); ++k) {
    body.markers.push_back({"feature_" + std::to_string(k), body.feature_points[k]});
  }
  return body;
}

force_estimation::Config MakeConfig(SensingScene::Update update) {
  force_estimation::Config config;
  if (update == SensingScene::Update::kOneStep) config.max_iterations = 0;
  return config;
}

Eigen::Vector3d HighestNode_m(const robot::RobotModel& model) {
  const Eigen::Matrix3Xd& nodes_m = model.body().mesh.nodes_m;
  Eigen::Index highest = 0;
  nodes_m.row(2).maxCoeff(&highest);
  return nodes_m.col(highest);
}

/// Grows by a fiftieth from step to step, so that a robot without cables moves, too.
Eigen::Vector3d ContactForce_N(int step) {
  return (1.0 + 0.02 * step) * Eigen::Vector3d(0.05, 0.02, -0.1);
}

}  // namespace

SensingScene::SensingScene(robot::RobotDescription description, int feature_points, Update update)
    : model_(MakeBody(std::move(description), feature_points)),
      site_{.patch = model_.Patch(HighestNode_m(model_), kPatchRadius_m)},
      fitter_(model_, MakeConfig(update)),
      update_(update) {
  fitter_.SetSites({site_});
  fem::StaticState equilibrium = model_.RestState();
  AddFrame(0, &equilibrium);
  external_force_N_ = equilibrium.loads.external_force_N;
  state_ = {.valid = true,
            .balanced = true,
            .x_m = equilibrium.x_m,
            .lambda_a_N = equilibrium.multipliers_N,
            .lambda_f_N = ContactForce_N(0)};
  for (int step = 1; step < kSteps; ++step) AddFrame(step, &equilibrium);
}

void SensingScene::AddFrame(int step, fem::StaticState* equilibrium) {
  using Kind = robot::CableCommand::Kind;
  Frame frame;
  frame.cables.assign(static_cast<size_t>(model_.CableCount()),
                      {.kind = Kind::kDisplacement, .value = kCableAtRest_m});
  if (!frame.cables.empty()) frame.cables.front().value += step * CableStep_m(update_);
  const fem::StaticResult result = model_.Solve(
      frame.cables, {{.weights = site_.patch.weights, .force_N = ContactForce_N(step)}},
      equilibrium);
  if (!result.status.ok()) throw RunError("no equilibrium: " + result.status.message());
  const auto& markers = model_.body().markers;
  const auto rows = static_cast<Eigen::Index>(3 * markers.size());
  frame.targets.rows = static_cast<int>(rows);
  frame.targets.weight = Eigen::VectorXd::Constant(rows, 1.0 / (kMarkerSigma_m * kMarkerSigma_m));
  frame.targets.position_m.resize(rows);
  for (size_t m = 0; m < markers.size(); ++m) {
    frame.targets.position_m.segment<3>(static_cast<Eigen::Index>(3 * m)) =
        markers[m].point.weights.Position(equilibrium->x_m);
  }
  frames_.push_back(std::move(frame));
}

void SensingScene::TakeFrame() {
  next_ = (next_ + 1) % (2 * frames_.size() - 2);
  const Frame& frame = frames_[next_ < frames_.size() ? next_ : 2 * frames_.size() - 2 - next_];
  state_.balanced = false;
  const force_estimation::MarkerFit& fit = fitter_.Fit(frame.targets, frame.cables, &state_);
  qp_steps_ = fit.status.ok() ? fit.iterations + 1 : fit.iterations;
  if (update_ == Update::kConverged) {
    if (!fit.status.ok()) throw RunError("the frame did not converge: " + fit.status.message());
    return;
  }
  // The fitter says so where it had to solve for the equilibrium because the step was too long.
  if (state_.balanced) throw RunError("the step left the range of the linear response");
}

}  // namespace palpate::benchmarks
