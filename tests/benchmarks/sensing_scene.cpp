// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/sensing_scene.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "libs/core/error.hpp"
#include "tests/support/feature_point_targets.hpp"

namespace palpate::benchmarks {

namespace {

constexpr int kSteps = 4;
constexpr int kStepsOfLarge = 2;
constexpr double kCableAtRest_m = 5e-3;
constexpr double kCableStep_m = 1e-3;
constexpr double kPatchRadius_m = 5e-3;
constexpr double kMarkerSigma_m = 1e-4;

robot::RobotBody MakeBody(NamedRobot robot, int feature_points) {
  robot.description.feature_points_m.resize(3, 0);
  robot.description.feature_point_count = feature_points;
  return test_support::WithFeaturePointsAsMarkers(BuildBody(robot));
}

force_estimation::Config MakeConfig(SensingScene::Update update) {
  force_estimation::Config config;
  config.frame_tolerance = 1e-8;
  if (update == SensingScene::Update::kWithChord) config.max_iterations = 1;
  return config;
}

/// The highest node of the body, and its feature point nearest to half that height.
std::vector<force_estimation::FitSite> MakeSites(const robot::RobotModel& model) {
  const Eigen::Matrix3Xd& nodes_m = model.body().mesh.nodes_m;
  Eigen::Index highest = 0;
  const double top_m = nodes_m.row(2).maxCoeff(&highest);
  const double middle_m = 0.5 * (top_m + nodes_m.row(2).minCoeff());
  const std::vector<fem::BodyPoint>& points = model.body().feature_points;
  const auto side = std::min_element(
      points.begin(), points.end(), [&](const fem::BodyPoint& a, const fem::BodyPoint& b) {
        return std::abs(a.rest_m.z() - middle_m) < std::abs(b.rest_m.z() - middle_m);
      });
  return {{.patch = model.Patch(nodes_m.col(highest), kPatchRadius_m)},
          {.patch = model.Patch(side->rest_m, kPatchRadius_m)}};
}

/// Grow by a fiftieth from step to step, so that a robot without cables moves, too.
Eigen::VectorXd ContactForces_N(int step) {
  Eigen::VectorXd forces_N(6);
  forces_N << 0.05, 0.02, -0.1, -0.04, 0.03, 0.05;
  return (1.0 + 0.02 * step) * forces_N;
}

}  // namespace

SensingScene::SensingScene(robot::RobotBody body, const Settings& settings)
    : model_(std::move(body), {}, settings.solver),
      sites_(MakeSites(model_)),
      fitter_(model_, MakeConfig(settings.update)),
      update_(settings.update) {
  fitter_.SetSites(sites_);
}

SensingScene::SensingScene(const NamedRobot& robot, const Settings& settings)
    : SensingScene(MakeBody(robot, settings.feature_points), settings) {
  fem::StaticState equilibrium = model_.RestState();
  AddFrame(0, &equilibrium);
  external_force_N_ = equilibrium.loads.external_force_N;
  first_state_ = {.valid = true,
                  .balanced = true,
                  .x_m = equilibrium.x_m,
                  .lambda_a_N = equilibrium.multipliers_N,
                  .lambda_f_N = ContactForces_N(0)};
  state_ = first_state_;
  const int steps = robot.large ? kStepsOfLarge : kSteps;
  for (int step = 1; step < steps; ++step) AddFrame(step, &equilibrium);
}

SensingScene::SensingScene(const SensingScene& computed, const Settings& settings)
    : SensingScene(computed.model_.body(), settings) {
  frames_ = computed.frames_;
  first_state_ = state_ = computed.first_state_;
  external_force_N_ = computed.external_force_N_;
}

void SensingScene::AddFrame(int step, fem::StaticState* equilibrium) {
  using Kind = robot::ActuatorCommand::Kind;
  Frame frame;
  frame.cables.assign(static_cast<size_t>(model_.ActuatorCount()),
                      {.kind = Kind::kDisplacement, .value = kCableAtRest_m});
  if (!frame.cables.empty()) frame.cables.front().value += step * kCableStep_m;
  const Eigen::VectorXd forces_N = ContactForces_N(step);
  std::vector<robot::DeadLoad> loads;
  for (size_t s = 0; s < sites_.size(); ++s) {
    loads.push_back({.weights = sites_[s].patch.weights,
                     .force_N = forces_N.segment<3>(static_cast<Eigen::Index>(3 * s))});
  }
  const fem::StaticResult result = model_.Solve(frame.cables, loads, equilibrium);
  if (!result.status.ok()) throw RunError("no equilibrium: " + result.status.message());
  frame.targets = test_support::ExactTargets(model_, equilibrium->x_m, kMarkerSigma_m);
  frames_.push_back(std::move(frame));
}

void SensingScene::TakeFrame() {
  next_ = (next_ + 1) % (2 * frames_.size() - 2);
  const Frame& frame = frames_[next_ < frames_.size() ? next_ : 2 * frames_.size() - 2 - next_];
  state_.balanced = false;
  const fem::TimeBudget budget =
      update_ == Update::kOneStep ? fem::TimeBudget(0.0) : fem::TimeBudget();
  const force_estimation::ForceFit& fit = fitter_.Fit(frame.targets, frame.cables, &state_, budget);
  qp_steps_ = fit.iterations;
  if (fit.continuation_steps > 0) throw RunError("the frame needed a static solve");
  const bool reached = update_ == Update::kConverged
                           ? fit.status.ok()
                           : fit.status.ok() || fit.status.code() == StatusCode::kBudgetReached;
  if (!reached) throw RunError("the frame did not converge: " + fit.status.message());
}

}  // namespace palpate::benchmarks
