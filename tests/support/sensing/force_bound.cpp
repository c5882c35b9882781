// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/support/sensing/force_bound.hpp"

#include <algorithm>
#include <cmath>

#include "components/force_estimation/shape/location_step.hpp"
#include "components/force_estimation/shape/temporal_correlation.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/linalg/cholesky.hpp"

namespace palpate::test_support {

namespace {

using correspondence::FeatureMatch;
using correspondence::MatchState;
using force_estimation::MaterialPoint;
using force_estimation::ShapeFrame;
using force_estimation::Tangents;

constexpr double kFriction = 0.3;
/// Of the model's motion: what the robot file's mesh is too stiff by (config/scenarios/README.md).
constexpr double kModelError = 0.015;
constexpr double kStep_m = 1e-3;  ///< of the places whose responses are compared
constexpr double kKnownPlace_m = 1e-6;

void Expect(const Status& status) {
  if (!status.ok()) throw RunError("no bound of a force: " + status.message());
}

/// Of each force: along the inward normal and two tangents, and of the place.
constexpr Eigen::Index kUnknowns = 5;

/// Sigma of |F| over |F| of the k-th of the forces, which are along their normals and tangents.
double Sigma(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& variance_m2,
             const std::vector<Eigen::Vector3d>& forces_N, std::size_t k, double place_sigma_m) {
  Eigen::MatrixXd information =
      jacobian.transpose() * variance_m2.cwiseInverse().asDiagonal() * jacobian;
  for (std::size_t f = 0; f < forces_N.size(); ++f) {
    auto of_force = information.diagonal().segment<kUnknowns>(kUnknowns * ToIndex(f));
    of_force.segment<2>(1).array() += std::pow(kFriction * forces_N[f].x(), -2);
    if (place_sigma_m > 0.0) of_force.tail<2>().array() += std::pow(place_sigma_m, -2);
  }
  Eigen::VectorXd along = Eigen::VectorXd::Zero(information.rows());
  along.segment<3>(kUnknowns * ToIndex(k)) = forces_N[k].normalized();
  return std::sqrt(along.dot(linalg::SolveSymmetric(information, along))) / forces_N[k].norm();
}

}  // namespace

struct ForceBounds::Rows {
  std::vector<robot::ObservationRow> rows;
  Eigen::VectorXd noise_m2;  ///< of the mean over the frames
  Eigen::VectorXd constant_m2;
};

ForceBounds::ForceBounds(robot::RobotModel& model, const force_estimation::ShapeConfig& shape)
    : model_(model),
      shape_(shape),
      features_(model.body()),
      matching_(features_, shape),
      map_(model),
      bias_(features_.Count(), shape),
      untouched_(model.RestState()) {}

void ForceBounds::Learn(const std::vector<ShapeFrame>& frames) {
  for (const ShapeFrame& frame : frames) {
    Expect(model_.Solve(frame.cables, {}, &untouched_).status);
    bias_.HaveCameras(frame.views.size());
    bias_.Learn(matching_.Match(frame, untouched_.x_m), untouched_.x_m, frame.Poses(), frame.epoch);
  }
  Expect(bias_.Finish());
}

ForceBounds::Rows ForceBounds::RowsOf(const ShapeFrame& frame, const Eigen::VectorXd& x_m,
                                      int frames) {
  const double left = std::min(1.0, force_estimation::kTemporalCorrelation / frames);
  const std::vector<FeatureMatch>& matches = matching_.Match(frame, x_m);
  Rows all;
  std::vector<double> noise_m2, constant_m2;
  for (std::size_t f = 0; f < matches.size(); ++f) {
    if (matches[f].state != MatchState::kMatched) continue;
    const robot::ObservationRow& row = matches[f].row;
    all.rows.push_back(row);
    noise_m2.push_back(left *
                       std::pow(bias_.NoiseScale(matches[f].camera) * matches[f].sigma_m, 2));
    const double moved_m = row.Value(x_m) - row.Value(untouched_.x_m);
    const double bias_m = bias_.CorrectionSigma_m(matches[f], frame.Poses());
    constant_m2.push_back(std::pow(bias_m, 2) + std::pow(kModelError * moved_m, 2));
  }
  all.noise_m2 = Eigen::Map<Eigen::VectorXd>(noise_m2.data(), std::ssize(noise_m2));
  all.constant_m2 = Eigen::Map<Eigen::VectorXd>(constant_m2.data(), std::ssize(constant_m2));
  return all;
}

/// The model under the frame's inputs and these forces, about which it is linearised.
fem::StaticState ForceBounds::Balance(const std::vector<virtual_robot::TrueForce>& truths,
                                      const ShapeFrame& frame) {
  fem::StaticState state = untouched_;
  Eigen::VectorXd load_N = Eigen::VectorXd::Zero(state.x_m.size());
  model_.AddWeight(load_N);
  std::vector<robot::DeadLoad> loads;
  for (const virtual_robot::TrueForce& truth : truths) {
    const Eigen::Vector3d rest_m = map_.NearestAtRest(truth.rest_position_m).rest_m;
    const fem::SurfacePatch patch = model_.Patch(rest_m, shape_.contact_radius_m);
    loads.push_back({patch.weights, truth.force_N});
    for (int axis = 0; axis < 3; ++axis) {
      const robot::ForceDirection push{patch.weights, Eigen::Vector3d::Unit(axis)};
      push.AddForce(truth.force_N[axis], load_N);
    }
  }
  Expect(model_.Solve(frame.cables, loads, &state).status);
  map_.Deform(state.x_m);
  Expect(model_.linearisation().Update(state.x_m, state.multipliers_N, load_N));
  return state;
}

/// [rows x 5] by the force along the inward normal and both tangents, and by the place along those.
Eigen::MatrixXd ForceBounds::Jacobian(const virtual_robot::TrueForce& truth,
                                      const force_estimation::ObservationJacobian& responses) {
  const MaterialPoint place = map_.NearestAtRest(truth.rest_position_m);
  const auto at = [&](const Eigen::Vector3d& rest_m) -> Eigen::MatrixX3d {
    const Eigen::Vector3d on_surface_m = map_.NearestAtRest(rest_m).rest_m;
    return responses.To(model_.Patch(on_surface_m, shape_.contact_radius_m).weights);
  };
  const Eigen::Vector3d normal = map_.NormalNow(place);
  const Eigen::MatrixX3d here = at(place.rest_m);
  const Eigen::Matrix<double, 3, 2> at_rest = Tangents(map_.NormalAtRest(place));
  Eigen::MatrixXd jacobian(here.rows(), kUnknowns);
  jacobian.col(0) = -here * normal;
  jacobian.middleCols<2>(1) = here * Tangents(normal);
  for (int t = 0; t < 2; ++t) {
    const Eigen::Vector3d step_m = kStep_m * at_rest.col(t);
    jacobian.col(3 + t) =
        (at(place.rest_m + step_m) - at(place.rest_m - step_m)) * truth.force_N / (2.0 * kStep_m);
  }
  return jacobian;
}

std::vector<ForceBound> ForceBounds::Of(const std::vector<virtual_robot::TrueForce>& truths,
                                        const ShapeFrame& frame, int frames) {
  const fem::StaticState state = Balance(truths, frame);
  const Rows rows = RowsOf(frame, state.x_m, frames);
  force_estimation::ObservationJacobian responses;
  Expect(responses.Add(model_, rows.rows, state.x_m, frame.cables, state.multipliers_N));
  Eigen::MatrixXd jacobian(std::ssize(rows.rows), kUnknowns * std::ssize(truths));
  std::vector<Eigen::Vector3d> forces_N;
  for (const virtual_robot::TrueForce& truth : truths) {
    const Eigen::Vector3d normal = map_.NormalNow(map_.NearestAtRest(truth.rest_position_m));
    jacobian.middleCols<kUnknowns>(kUnknowns * std::ssize(forces_N)) = Jacobian(truth, responses);
    forces_N.emplace_back() << -normal.dot(truth.force_N),
        Tangents(normal).transpose() * truth.force_N;
  }
  const Eigen::VectorXd whole_m2 = rows.noise_m2 + rows.constant_m2;
  std::vector<ForceBound> bounds;
  for (std::size_t k = 0; k < forces_N.size(); ++k) {
    bounds.push_back({.noise = Sigma(jacobian, rows.noise_m2, forces_N, k, 0.0),
                      .whole = Sigma(jacobian, whole_m2, forces_N, k, 0.0),
                      .at_place = Sigma(jacobian, whole_m2, forces_N, k, kKnownPlace_m)});
  }
  return bounds;
}

}  // namespace palpate::test_support
