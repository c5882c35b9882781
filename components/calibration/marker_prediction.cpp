// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/marker_prediction.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/robot/sensitivity/equilibrium_sensitivity.hpp"

namespace palpate::calibration {

MarkerPredictor::MarkerPredictor(robot::RobotModel& model,
                                 const std::vector<StaticObservation>& observations,
                                 std::vector<int> materials)
    : model_(model),
      observations_(observations),
      materials_(std::move(materials)),
      states_(observations.size(), model.RestState()),
      accepted_(states_) {
  for (const StaticObservation& observation : observations) {
    PALPATE_CHECK(observation.position_m.size() == MarkerRows(), observation.name);
    PALPATE_CHECK(observation.variance_m2.size() == MarkerRows(), observation.name);
    PALPATE_CHECK(observation.reference == ReferenceShape::kNone ||
                      observation.reference_position_m.size() == MarkerRows(),
                  observation.name);
    rows_ += static_cast<int>((observation.variance_m2.array() > 0.0).count());
  }
}

Eigen::Index MarkerPredictor::MarkerRows() const {
  return ToIndex(3 * model_.body().markers.size());
}

void MarkerPredictor::SetModuli(const Eigen::VectorXd& log_modulus) {
  for (Eigen::Index p = 0; p < log_modulus.size(); ++p) {
    model_.SetYoungsModulus(materials_[At(p)], std::exp(log_modulus[p]));
  }
}

Status MarkerPredictor::Predict(const Eigen::VectorXd& log_modulus, Prediction* prediction) {
  SetModuli(log_modulus);
  states_ = accepted_;
  prediction->scaled_residual.resize(rows_);
  prediction->scaled_jacobian.resize(rows_, log_modulus.size());
  prediction->residual_rms_m.clear();
  Eigen::Index row = 0;
  double sum_m2 = 0.0;
  for (size_t o = 0; o < observations_.size(); ++o) {
    const StaticObservation& observation = observations_[o];
    model_.SetGravity(observation.gravity_m_s2);
    Markers markers;
    Status status = PredictEquilibrium(observation, observation.loads, &states_[o], &markers);
    if (!status.ok()) return status;
    Eigen::VectorXd residual_m = observation.position_m - markers.position_m;
    if (observation.reference != ReferenceShape::kNone) {
      Markers reference;
      status = PredictReference(observation, &reference);
      if (!status.ok()) return status;
      residual_m += reference.position_m - observation.reference_position_m;
      markers.jacobian_m -= reference.jacobian_m;
    }
    const Eigen::Index first = row;
    AppendRows(observation, residual_m, markers.jacobian_m, &row, prediction);
    const double rms_m = prediction->residual_rms_m.back();
    sum_m2 += rms_m * rms_m * static_cast<double>(row - first);
  }
  prediction->residual_rms_all_m = std::sqrt(sum_m2 / std::max(1, rows_));
  return Status::Ok();
}

/// All internal forces of a material are proportional to its modulus, so that they are their own
/// derivative with respect to ln E.
Status MarkerPredictor::PredictEquilibrium(const StaticObservation& observation,
                                           const std::vector<robot::DeadLoad>& loads,
                                           fem::StaticState* state, Markers* markers) {
  const fem::StaticResult result = model_.Solve(observation.cables, loads, state);
  if (!result.status.ok()) {
    return {result.status.code(),
            observation.name + ": no equilibrium was reached: " + result.status.message()};
  }
  const auto moduli = ToIndex(materials_.size());
  Eigen::MatrixXd force_derivative = Eigen::MatrixXd::Zero(state->x_m.size(), moduli);
  for (Eigen::Index p = 0; p < moduli; ++p) {
    Eigen::VectorXd internal = Eigen::VectorXd::Zero(state->x_m.size());
    model_.elastic_body().AddForcesOfMaterial(materials_[At(p)], state->x_m, internal);
    force_derivative.col(p) = -internal;
  }
  Eigen::MatrixXd dx;
  Status status =
      robot::EquilibriumSensitivity(model_, observation.cables, *state, force_derivative, &dx);
  if (!status.ok()) return {status.code(), observation.name + ": " + status.message()};
  markers->position_m = MarkersAt(state->x_m);
  markers->jacobian_m.resize(MarkerRows(), moduli);
  for (Eigen::Index p = 0; p < moduli; ++p) markers->jacobian_m.col(p) = MarkersAt(dx.col(p));
  return status;
}

Status MarkerPredictor::PredictReference(const StaticObservation& observation, Markers* markers) {
  fem::StaticState rest = model_.RestState();
  if (observation.reference == ReferenceShape::kEquilibrium) {
    return PredictEquilibrium(observation, {}, &rest, markers);
  }
  markers->position_m = MarkersAt(rest.x_m);
  markers->jacobian_m.setZero(MarkerRows(), ToIndex(materials_.size()));
  return Status::Ok();
}

/// Appends the observed coordinates.
void MarkerPredictor::AppendRows(const StaticObservation& observation,
                                 const Eigen::VectorXd& residual_m,
                                 const Eigen::MatrixXd& jacobian_m, Eigen::Index* row,
                                 Prediction* prediction) {
  double sum_m2 = 0.0;
  int used = 0;
  for (Eigen::Index i = 0; i < residual_m.size(); ++i) {
    if (!(observation.variance_m2[i] > 0.0)) continue;
    const double sigma_m = std::sqrt(observation.variance_m2[i]);
    prediction->scaled_residual[*row] = residual_m[i] / sigma_m;
    prediction->scaled_jacobian.row((*row)++) = jacobian_m.row(i) / sigma_m;
    sum_m2 += residual_m[i] * residual_m[i];
    ++used;
  }
  prediction->residual_rms_m.push_back(std::sqrt(sum_m2 / std::max(1, used)));
}

Eigen::VectorXd MarkerPredictor::MarkersAt(const Eigen::Ref<const Eigen::VectorXd>& nodal) const {
  const auto& markers = model_.body().markers;
  Eigen::VectorXd positions(MarkerRows());
  for (size_t m = 0; m < markers.size(); ++m) {
    positions.segment<3>(ToIndex(3 * m)) = markers[m].point.weights.Position(nodal);
  }
  return positions;
}

}  // namespace palpate::calibration
