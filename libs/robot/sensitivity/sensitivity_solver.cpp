// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/sensitivity/sensitivity_solver.hpp"

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"

namespace palpate::robot {

SensitivitySolver::SensitivitySolver(RobotModel& model)
    : model_(model),
      point_(model),
      cables_(point_),
      columns_(model.linearisation().Size(), 0),
      nodal_(model.elastic_body().rest_m().size()) {}

Status SensitivitySolver::Compute(const std::vector<ActuatorCommand>& cables,
                                  const fem::StaticState& state,
                                  std::span<const ParameterPtr> parameters, Factor factor) {
  Status status = TryCompute(cables, state, parameters, factor);
  if (!status.ok()) {
    columns_of_.clear();
    length_m_.resize(model_.ActuatorCount(), 0);
    tension_N_.resize(model_.ActuatorCount(), 0);
  }
  return status;
}

Status SensitivitySolver::TryCompute(const std::vector<ActuatorCommand>& cables,
                                     const fem::StaticState& state,
                                     std::span<const ParameterPtr> parameters, Factor factor) {
  if (Status status = FactorAt(state, factor, &model_.linearisation()); !status.ok()) return status;
  point_.Set(cables, state);
  cables_.Evaluate();
  DescribeParameters(parameters);
  FillColumns();
  const Eigen::Index count = cables_.TautCount() + loads_ + cables_.TurnCount();
  model_.linearisation().Solve(columns_.leftCols(count));
  if (Status status = CoupleFriction(); !status.ok()) return status;
  return EliminateTautCables();
}

void SensitivitySolver::DescribeParameters(std::span<const ParameterPtr> parameters) {
  columns_of_.resize(parameters.size());
  load_of_.resize(parameters.size());
  loads_ = 0;
  for (size_t p = 0; p < parameters.size(); ++p) {
    ParameterColumn& column = columns_of_[p];
    column.Reset(point_.x_m().size(), model_.ActuatorCount());
    parameters[p]->Describe(point_, &column);
    point_.Complete(&column);
    load_of_[p] = column.HasForce() ? static_cast<int>(loads_++) : -1;
  }
}

void SensitivitySolver::FillColumns() {
  const Eigen::Index taut = cables_.TautCount();
  const Eigen::Index turns = cables_.TurnCount();
  const fem::StiffnessMatrix& matrix = model_.linearisation().matrix();
  if (columns_.cols() < taut + loads_ + turns) {
    columns_.resize(matrix.Size(), taut + loads_ + turns);
  }
  for (Eigen::Index t = 0; t < taut; ++t) {
    nodal_.setZero();
    model_.actuator(cables_.taut()[At(t)]).AddGradient(point_.x_m(), -1.0, nodal_);
    matrix.Reduce(nodal_, columns_.col(t));
  }
  for (size_t p = 0; p < columns_of_.size(); ++p) {
    if (load_of_[p] < 0) continue;
    nodal_.setZero();
    columns_of_[p].AddForceTo(nodal_);
    matrix.Reduce(nodal_, columns_.col(taut + load_of_[p]));
  }
  cables_.FillTurnForces(columns_.middleCols(taut + loads_, turns));
}

/// (K + A B')^-1 y = z - Z (I + B' Z)^-1 B' z with z = K^-1 y and Z = K^-1 A.
Status SensitivitySolver::CoupleFriction() {
  const Eigen::Index turns = cables_.TurnCount();
  if (turns == 0) return Status::Ok();
  const Eigen::Index others = cables_.TautCount() + loads_;
  const auto Z = columns_.middleCols(others, turns);
  Eigen::MatrixXd coupling(turns, turns);
  Eigen::MatrixXd angles(turns, others);
  for (Eigen::Index i = 0; i < turns; ++i) {
    const NodalRow& B = cables_.angles()[At(i)];
    for (Eigen::Index j = 0; j < turns; ++j) coupling(i, j) = B.Dot(Z.col(j));
    for (Eigen::Index j = 0; j < others; ++j) angles(i, j) = B.Dot(columns_.col(j));
  }
  if (Status status = UndoTurns(std::move(coupling), &angles); !status.ok()) return status;
  columns_.leftCols(others).noalias() -= Z * angles;
  return Status::Ok();
}

Status SensitivitySolver::EliminateTautCables() {
  const Eigen::Index taut = cables_.TautCount();
  const Eigen::Index cables = model_.ActuatorCount();
  const Eigen::Index count = ParameterCount();
  commanded_length_m_.resize(cables, count);
  length_m_.resize(cables, count);
  tension_N_.resize(cables, count);
  for (Eigen::Index p = 0; p < count; ++p) {
    const ParameterColumn& column = columns_of_[At(p)];
    commanded_length_m_.col(p) = column.commanded_length_m;
    length_m_.col(p) = column.length_m;
    tension_N_.col(p) = column.commanded_tension_N;
  }
  fem::QpMatrix per_tension(cables, taut);  // dlength/dtension
  for (Eigen::Index c = 0; c < cables; ++c) {
    const NodalRow& row = cables_.lengths()[At(c)];
    for (Eigen::Index p = 0; p < count; ++p) {
      const int load = load_of_[At(p)];
      if (load >= 0) length_m_(c, p) += row.Dot(columns_.col(taut + load));
    }
    for (Eigen::Index t = 0; t < taut; ++t) per_tension(c, t) = row.Dot(columns_.col(t));
  }
  return cables_.HoldLengths(per_tension, commanded_length_m_, &length_m_, &tension_N_);
}

void SensitivitySolver::PointMotions(std::span<const fem::InterpolationWeights> points,
                                     Eigen::MatrixXd* motions_m) const {
  const Eigen::Index taut = cables_.TautCount();
  motions_m->setZero(ToIndex(3 * points.size()), ParameterCount());
  for (size_t e = 0; e < points.size(); ++e) {
    const auto row = ToIndex(3 * e);
    for (size_t k = 0; k < points[e].nodes.size(); ++k) {
      const int node = points[e].nodes[k];
      const int free_node = model_.linearisation().matrix().FreeIndex(node);
      for (Eigen::Index p = 0; p < ParameterCount(); ++p) {
        const ParameterColumn& column = columns_of_[At(p)];
        Eigen::Vector3d moved = Eigen::Vector3d::Zero();
        if (column.HasHeldMotion()) moved = column.held_motion_m().segment<3>(3 * node);
        if (free_node >= 0) {
          const int load = load_of_[At(p)];
          if (load >= 0) moved += columns_.col(taut + load).segment<3>(3 * free_node);
          for (Eigen::Index t = 0; t < taut; ++t) {
            moved +=
                tension_N_(cables_.taut()[At(t)], p) * columns_.col(t).segment<3>(3 * free_node);
          }
        }
        motions_m->col(p).segment<3>(row) += points[e].weights[k] * moved;
      }
    }
  }
}

Eigen::Matrix3Xd SensitivitySolver::PointMotion(const fem::InterpolationWeights& point) const {
  Eigen::MatrixXd motion_m;
  PointMotions({&point, 1}, &motion_m);
  return motion_m;
}

void SensitivitySolver::NodalMotion(int parameter, Eigen::VectorXd* motion_m) const {
  PALPATE_CHECK(parameter >= 0 && parameter < ParameterCount(), parameter);
  const Eigen::Index taut = cables_.TautCount();
  const fem::StiffnessMatrix& matrix = model_.linearisation().matrix();
  const ParameterColumn& column = columns_of_[At(parameter)];
  motion_m->setZero(point_.x_m().size());
  if (column.HasHeldMotion()) *motion_m = column.held_motion_m();
  const int load = load_of_[At(parameter)];
  if (load >= 0) matrix.AddExpanded(columns_.col(taut + load), 1.0, *motion_m);
  for (Eigen::Index t = 0; t < taut; ++t) {
    matrix.AddExpanded(columns_.col(t), tension_N_(cables_.taut()[At(t)], parameter), *motion_m);
  }
}

}  // namespace palpate::robot
