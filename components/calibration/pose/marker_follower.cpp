// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/pose/marker_follower.hpp"

#include "libs/core/index.hpp"
#include "libs/fem/equilibrium_step.hpp"

namespace palpate::calibration {

namespace {

struct MarkerFollowerTuning {
  /// Of the load continuation: a change of tensions that needs more steps is halved.
  fem::StaticSettings continuation{.max_newton_iterations = 20, .max_load_steps = 6};
  int halvings = 6;  ///< of the change; more reach farther and cost a solve each
  /// Residual over the forces above which a linearised step has failed: less continues more often.
  double astray = 0.5;
};
constexpr MarkerFollowerTuning kFollowerTuning;

std::vector<robot::ObservationRow> RowsOf(const robot::RobotModel& model,
                                          const std::vector<MarkerSighting>& sightings) {
  std::vector<fem::InterpolationWeights> points;
  for (const MarkerSighting& sighting : sightings) {
    points.push_back(model.body().markers.at(At(sighting.marker)).point.weights);
  }
  return robot::RowsOfPoints(points);
}

std::vector<robot::ActuatorCommand> Tensions(const Eigen::VectorXd& lambda_a_N) {
  std::vector<robot::ActuatorCommand> commands;
  for (const double tension_N : lambda_a_N) {
    commands.push_back({robot::ActuatorCommand::Kind::kTension, tension_N});
  }
  return commands;
}

}  // namespace

MarkerFollower::MarkerFollower(robot::RobotModel& model,
                               const std::vector<MarkerSighting>& sightings)
    : model_(model),
      rows_(RowsOf(model, sightings)),
      compliance_(model.linearisation(), rows_),
      equilibrium_(model.linearisation(), kFollowerTuning.continuation),
      weight_N_(Eigen::VectorXd::Zero(model.elastic_body().rest_m().size())) {
  model_.AddWeight(weight_N_);
}

Status MarkerFollower::Start(const Eigen::VectorXd& lambda_a_N) {
  balanced_ = model_.RestState();
  restorations_ = 0;
  const Status status = model_.Solve(Tensions(lambda_a_N), {}, &balanced_).status;
  state_ = balanced_;
  return status;
}

Status MarkerFollower::Linearise() {
  Status status = TryLinearise();
  if (status.ok()) return status;
  status = FollowEquilibrium(state_.multipliers_N);
  return status.ok() ? TryLinearise() : status;
}

Status MarkerFollower::TryLinearise() {
  fem::Linearisation& linearisation = model_.linearisation();
  const Status status = linearisation.Update(state_.x_m, state_.multipliers_N, weight_N_);
  if (!status.ok()) return status;
  compliance_.Compute(state_.x_m, model_.actuator_rest_m(), state_.multipliers_N, {});
  tangent_lambda_a_N_ = state_.multipliers_N;
  return status;
}

void MarkerFollower::KeepTangent() {
  // The linearisation has the residual after the last step.
  compliance_.ComputeChord(state_.x_m, model_.actuator_rest_m(), state_.multipliers_N, {});
}

Status MarkerFollower::MoveTo(const Eigen::VectorXd& lambda_a_N) {
  const Status status = TakeLinearStep(lambda_a_N);
  return status.ok() ? status : FollowEquilibrium(lambda_a_N);
}

Status MarkerFollower::TakeLinearStep(const Eigen::VectorXd& lambda_a_N) {
  fem::StaticState moved = state_;
  moved.multipliers_N = lambda_a_N;
  moved.loads = model_.Loads(Tensions(lambda_a_N), {});
  compliance_.UpdateConfiguration(lambda_a_N, {}, 1.0, &moved.x_m);
  fem::Linearisation& linearisation = model_.linearisation();
  const Status status = linearisation.UpdateResidual(moved.x_m, lambda_a_N, weight_N_);
  if (!status.ok()) return status;
  const double error =
      linearisation.residual_N().norm() / fem::ForceScale_N(linearisation, moved.loads, lambda_a_N);
  if (!(error < kFollowerTuning.astray)) {
    return {StatusCode::kNotConverged, "the linearised step diverges"};
  }
  balance_error_ = error;
  state_ = std::move(moved);
  return status;
}

Status MarkerFollower::FollowEquilibrium(const Eigen::VectorXd& lambda_a_N) {
  ++restorations_;
  const Eigen::VectorXd start_N = balanced_.multipliers_N;
  Status status;
  double fraction = 1.0;
  for (int halving = 0; halving <= kFollowerTuning.halvings; ++halving, fraction *= 0.5) {
    fem::StaticState attempt = balanced_;
    const Eigen::VectorXd tension_N = start_N + fraction * (lambda_a_N - start_N);
    status = equilibrium_.Solve(model_.Loads(Tensions(tension_N), {}), &attempt).status;
    if (!status.ok()) continue;
    state_ = balanced_ = std::move(attempt);
    balance_error_ = 0.0;
    return status;
  }
  return status;
}

Status MarkerFollower::Balance() {
  return model_.Solve(Tensions(state_.multipliers_N), {}, &state_).status;
}

Eigen::Matrix3Xd MarkerFollower::Markers_m() const {
  Eigen::Matrix3Xd markers_m(3, ToIndex(rows_.size() / 3));
  for (size_t row = 0; row < rows_.size(); ++row) {
    markers_m.reshaped()[ToIndex(row)] = rows_[row].Value(state_.x_m);
  }
  return markers_m;
}

}  // namespace palpate::calibration
