// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/support/sensing/force_bound.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "components/force_estimation/shape/location_step.hpp"
#include "components/force_estimation/shape/observation_jacobian.hpp"
#include "components/force_estimation/shape/temporal_correlation.hpp"
#include "libs/core/check.hpp"
#include "libs/core/error.hpp"

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

/// Sigma of |F| over |F|: of the force along the inward normal and two tangents, and of the place.
double Sigma(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& variance_m2,
             const Eigen::Vector3d& force_N, double place_sigma_m) {
  Eigen::Matrix<double, 5, 5> information =
      jacobian.transpose() * variance_m2.cwiseInverse().asDiagonal() * jacobian;
  information.diagonal().segment<2>(1).array() += std::pow(kFriction * force_N.x(), -2);
  if (place_sigma_m > 0.0) {
    information.diagonal().tail<2>().array() += std::pow(place_sigma_m, -2);
  }
  Eigen::Vector<double, 5> along = Eigen::Vector<double, 5>::Zero();
  along.head<3>() = force_N.normalized();
  return std::sqrt(along.dot(Eigen::LDLT<Eigen::Matrix<double, 5, 5>>(information).solve(along))) /
         force_N.norm();
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

/// [rows x 5] by the force along the inward normal and both tangents, and by the place along those.
Eigen::MatrixXd ForceBounds::Jacobian(const virtual_robot::TrueForce& truth,
                                      const MaterialPoint& place, const ShapeFrame& frame,
                                      const fem::StaticState& state,
                                      const std::vector<robot::ObservationRow>& rows) {
  force_estimation::ObservationJacobian responses;
  Expect(responses.Add(model_, rows, state.x_m, frame.cables, state.multipliers_N));
  const auto at = [&](const Eigen::Vector3d& rest_m) -> Eigen::MatrixX3d {
    const Eigen::Vector3d on_surface_m = map_.NearestAtRest(rest_m).rest_m;
    return responses.To(model_.Patch(on_surface_m, shape_.contact_radius_m).weights);
  };
  const Eigen::Vector3d normal = map_.NormalNow(place);
  const Eigen::MatrixX3d here = at(place.rest_m);
  PALPATE_CHECK(here.rows() == std::ssize(rows), here.rows(), rows.size());
  const Eigen::Matrix<double, 3, 2> at_rest = Tangents(map_.NormalAtRest(place));
  Eigen::MatrixXd jacobian(here.rows(), 5);
  jacobian.col(0) = -here * normal;
  jacobian.middleCols<2>(1) = here * Tangents(normal);
  for (int t = 0; t < 2; ++t) {
    const Eigen::Vector3d step_m = kStep_m * at_rest.col(t);
    jacobian.col(3 + t) =
        (at(place.rest_m + step_m) - at(place.rest_m - step_m)) * truth.force_N / (2.0 * kStep_m);
  }
  return jacobian;
}

ForceBound ForceBounds::Of(const virtual_robot::TrueForce& truth, const ShapeFrame& frame,
                           int frames) {
  const MaterialPoint place = map_.NearestAtRest(truth.rest_position_m);
  const fem::SurfacePatch patch = model_.Patch(place.rest_m, shape_.contact_radius_m);
  fem::StaticState state = untouched_;
  Expect(model_.Solve(frame.cables, {{patch.weights, truth.force_N}}, &state).status);
  map_.Deform(state.x_m);
  Eigen::VectorXd load_N = Eigen::VectorXd::Zero(state.x_m.size());
  model_.AddWeight(load_N);
  for (int axis = 0; axis < 3; ++axis) {
    const robot::ForceDirection push{patch.weights, Eigen::Vector3d::Unit(axis)};
    push.AddForce(truth.force_N[axis], load_N);
  }
  Expect(model_.linearisation().Update(state.x_m, state.multipliers_N, load_N));
  const Rows rows = RowsOf(frame, state.x_m, frames);
  const Eigen::MatrixXd jacobian = Jacobian(truth, place, frame, state, rows.rows);
  const Eigen::Vector3d normal = map_.NormalNow(place);
  Eigen::Vector3d force_N;
  force_N << -normal.dot(truth.force_N), Tangents(normal).transpose() * truth.force_N;
  const Eigen::VectorXd whole_m2 = rows.noise_m2 + rows.constant_m2;
  return {.noise = Sigma(jacobian, rows.noise_m2, force_N, 0.0),
          .whole = Sigma(jacobian, whole_m2, force_N, 0.0),
          .at_place = Sigma(jacobian, whole_m2, force_N, kKnownPlace_m)};
}

}  // namespace palpate::test_support
