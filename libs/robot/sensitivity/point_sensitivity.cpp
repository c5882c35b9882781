// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/sensitivity/point_sensitivity.hpp"

#include <algorithm>

#include "libs/core/index.hpp"

namespace palpate::robot {

PointSensitivity::PointSensitivity(RobotModel& model, std::vector<ObservationRow> rows)
    : model_(model), point_(model), cables_(point_), nodal_(model.elastic_body().rest_m().size()) {
  SetRows(std::move(rows));
}

PointSensitivity::PointSensitivity(RobotModel& model,
                                   const std::vector<fem::InterpolationWeights>& points)
    : PointSensitivity(model, RowsOfPoints(points)) {}

void PointSensitivity::SetRows(std::vector<ObservationRow> rows) {
  observed_ = std::move(rows);
  rows_ = model_.ActuatorCount() + std::ssize(observed_);
}

Status PointSensitivity::Compute(const std::vector<ActuatorCommand>& cables,
                                 const fem::StaticState& state,
                                 std::span<const ParameterPtr> parameters, Factor factor) {
  Status status = TryCompute(cables, state, parameters, factor);
  if (!status.ok()) Clear();
  return status;
}

Status PointSensitivity::ComputeAgain(const std::vector<ActuatorCommand>& cables,
                                      const fem::StaticState& state,
                                      std::span<const ParameterPtr> parameters) {
  point_.Set(cables, state);
  cables_.Evaluate();
  Status status = Describe(parameters);
  if (!status.ok()) Clear();
  return status;
}

void PointSensitivity::Clear() {
  motion_m_.resize(rows_ - model_.ActuatorCount(), 0);
  length_m_.resize(model_.ActuatorCount(), 0);
  tension_N_.resize(model_.ActuatorCount(), 0);
}

Status PointSensitivity::TryCompute(const std::vector<ActuatorCommand>& cables,
                                    const fem::StaticState& state,
                                    std::span<const ParameterPtr> parameters, Factor factor) {
  if (Status status = FactorAt(state, factor, &model_.linearisation()); !status.ok()) return status;
  point_.Set(cables, state);
  cables_.Evaluate();
  if (Status status = SolveRows(); !status.ok()) return status;
  return Describe(parameters);
}

Status PointSensitivity::Describe(std::span<const ParameterPtr> parameters) {
  DescribeParameters(parameters);
  return PullTautCables();
}

Status PointSensitivity::SolveRows() {
  FillRows();
  model_.linearisation().Solve(columns_.leftCols(rows_ + cables_.TurnCount()));
  if (Status status = CoupleFriction(); !status.ok()) return status;
  per_force_m_N_.resize(rows_, nodal_.size());
  for (Eigen::Index r = 0; r < rows_; ++r) {
    nodal_.setZero();
    model_.linearisation().matrix().AddExpanded(columns_.col(r), 1.0, nodal_);
    per_force_m_N_.row(r) = nodal_.transpose();
  }
  return Status::Ok();
}

void PointSensitivity::FillRows() {
  const fem::StiffnessMatrix& matrix = model_.linearisation().matrix();
  const Eigen::Index count = rows_ + cables_.TurnCount();
  if (columns_.cols() < count) columns_.resize(matrix.Size(), count);
  columns_.leftCols(count).setZero();
  Eigen::Index row = 0;
  for (const NodalRow& length : cables_.lengths()) length.AddTo(columns_.col(row++));
  for (const ObservationRow& observed : observed_) {
    for (size_t k = 0; k < observed.nodes.size(); ++k) {
      const int free_node = matrix.FreeIndex(observed.nodes[k]);
      if (free_node >= 0) columns_.col(row).segment<3>(3 * free_node) += observed.coefficients[k];
    }
    ++row;
  }
  for (const NodalRow& angle : cables_.angles()) angle.AddTo(columns_.col(row++));
}

/// (K + A B')^-T y = z - Z (I + A' Z)^-1 A' z with z = K^-1 y and Z = K^-1 B.
Status PointSensitivity::CoupleFriction() {
  const Eigen::Index turns = cables_.TurnCount();
  if (turns == 0) return Status::Ok();
  Eigen::MatrixXd A(columns_.rows(), turns);
  cables_.FillTurnForces(A);
  const auto Z = columns_.middleCols(rows_, turns);
  Eigen::MatrixXd along = A.transpose() * columns_.leftCols(rows_);
  if (Status status = UndoTurns(A.transpose() * Z, &along); !status.ok()) return status;
  columns_.leftCols(rows_).noalias() -= Z * along;
  return Status::Ok();
}

void PointSensitivity::DescribeParameters(std::span<const ParameterPtr> parameters) {
  const Eigen::Index cables = model_.ActuatorCount();
  const auto count = ToIndex(parameters.size());
  commanded_length_m_.resize(cables, count);
  length_m_.resize(cables, count);
  tension_N_.resize(cables, count);
  motion_m_.setZero(rows_ - cables, count);
  response_m_.setZero(rows_, count);
  distributed_.clear();
  for (Eigen::Index p = 0; p < count; ++p) {
    column_.Reset(nodal_.size(), cables);
    parameters[At(p)]->Describe(point_, &column_);
    point_.Complete(&column_);
    commanded_length_m_.col(p) = column_.commanded_length_m;
    length_m_.col(p) = column_.length_m;
    tension_N_.col(p) = column_.commanded_tension_N;
    if (column_.HasHeldMotion()) MoveWithBase(p);
    for (const auto& [node, force_N] : column_.point_forces_N()) {
      response_m_.col(p) += per_force_m_N_.middleCols<3>(3 * node) * force_N;
    }
    if (!column_.IsDistributed()) continue;
    const auto next = ToIndex(distributed_.size());
    if (next == distributed_N_.cols()) {
      distributed_N_.conservativeResize(nodal_.size(), std::max<Eigen::Index>(8, 2 * next));
    }
    distributed_N_.col(next) = column_.distributed_force_N();
    distributed_.push_back(p);
  }
  const auto distributed = ToIndex(distributed_.size());
  const Eigen::MatrixXd moved_m = per_force_m_N_ * distributed_N_.leftCols(distributed);
  for (Eigen::Index k = 0; k < distributed; ++k) {
    response_m_.col(distributed_[At(k)]) += moved_m.col(k);
  }
  length_m_ += response_m_.topRows(cables);
  motion_m_ += response_m_.bottomRows(rows_ - cables);
}

/// What the held nodes carry along at fixed free ones.
void PointSensitivity::MoveWithBase(Eigen::Index parameter) {
  for (size_t e = 0; e < observed_.size(); ++e) {
    motion_m_(ToIndex(e), parameter) = observed_[e].Value(column_.held_motion_m());
  }
}

Status PointSensitivity::PullTautCables() {
  const Eigen::Index cables = model_.ActuatorCount();
  const Eigen::Index taut = cables_.TautCount();
  Eigen::MatrixXd per_tension(rows_, taut);
  for (Eigen::Index t = 0; t < taut; ++t) {
    nodal_.setZero();
    model_.actuator(cables_.taut()[At(t)]).AddGradient(point_.x_m(), -1.0, nodal_);
    per_tension.col(t) = per_force_m_N_ * nodal_;
  }
  Status status = cables_.HoldLengths(per_tension.topRows(cables), commanded_length_m_, &length_m_,
                                      &tension_N_);
  if (!status.ok()) return status;
  for (Eigen::Index t = 0; t < taut; ++t) {
    motion_m_.noalias() +=
        per_tension.bottomRows(rows_ - cables).col(t) * tension_N_.row(cables_.taut()[At(t)]);
  }
  return Status::Ok();
}

}  // namespace palpate::robot
