// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/sensitivity/sensitivity_solver.hpp"

#include <Eigen/LU>

#include "libs/core/check.hpp"
#include "libs/fem/bounded_qp.hpp"

namespace palpate::robot {

SensitivitySolver::SensitivitySolver(RobotModel& model)
    : model_(model),
      point_(model),
      columns_(model.linearisation().Size(), 0),
      nodal_(model.elastic_body().rest_m().size()) {}

double SensitivitySolver::NodalRow::Dot(const Eigen::Ref<const Eigen::VectorXd>& column) const {
  double sum = 0.0;
  for (const auto& [node, entry] : entries) sum += entry.dot(column.segment<3>(3 * node));
  return sum;
}

Status SensitivitySolver::Compute(const std::vector<CableCommand>& cables,
                                  const fem::StaticState& state,
                                  std::span<const ParameterPtr> parameters, Factor factor) {
  Status status = TryCompute(cables, state, parameters, factor);
  if (!status.ok()) {
    columns_of_.clear();
    length_m_.resize(model_.CableCount(), 0);
    tension_N_.resize(model_.CableCount(), 0);
  }
  return status;
}

Status SensitivitySolver::TryCompute(const std::vector<CableCommand>& cables,
                                     const fem::StaticState& state,
                                     std::span<const ParameterPtr> parameters, Factor factor) {
  fem::Linearisation& linearisation = model_.linearisation();
  if (factor == Factor::kRenew) {
    Status status =
        linearisation.Update(state.x_m, state.multipliers_N, state.loads.external_force_N);
    if (!status.ok()) return status;
  }
  if (linearisation.shifted()) return {StatusCode::kNotPositiveDefinite, "the factor is shifted"};
  point_.Set(cables, state);
  DescribeParameters(parameters);
  FindTautCables();
  FillColumns();
  linearisation.Solve(columns_.leftCols(static_cast<Eigen::Index>(taut_.size()) + loads_ + turns_));
  if (Status status = CoupleFriction(); !status.ok()) return status;
  return EliminateTautCables();
}

void SensitivitySolver::DescribeParameters(std::span<const ParameterPtr> parameters) {
  columns_of_.resize(parameters.size());
  load_of_.resize(parameters.size());
  loads_ = 0;
  for (size_t p = 0; p < parameters.size(); ++p) {
    ParameterColumn& column = columns_of_[p];
    column.Reset(point_.x_m().size(), model_.CableCount());
    parameters[p]->Describe(point_, &column);
    point_.Complete(&column);
    load_of_[p] = column.HasForce() ? static_cast<int>(loads_++) : -1;
  }
}

void SensitivitySolver::FindTautCables() {
  taut_.clear();
  turns_ = 0;
  for (int c = 0; c < model_.CableCount(); ++c) {
    if (point_.KeepsLength(c)) taut_.push_back(c);
    if (Rubs(c)) turns_ += point_.path(c).TurnCount();
  }
}

bool SensitivitySolver::Rubs(int cable) const {
  return point_.tension_N(cable) > 0.0 && model_.cable(cable).friction().coefficient > 0.0;
}

void SensitivitySolver::FillColumns() {
  const auto taut = static_cast<Eigen::Index>(taut_.size());
  const fem::StiffnessMatrix& matrix = model_.linearisation().matrix();
  if (columns_.cols() < taut + loads_ + turns_) {
    columns_.resize(matrix.Size(), taut + loads_ + turns_);
  }
  for (Eigen::Index t = 0; t < taut; ++t) {
    nodal_.setZero();
    model_.cable(taut_[static_cast<size_t>(t)]).AddGradient(point_.x_m(), -1.0, nodal_);
    matrix.Reduce(nodal_, columns_.col(t));
  }
  for (size_t p = 0; p < columns_of_.size(); ++p) {
    if (load_of_[p] < 0) continue;
    const ParameterColumn& column = columns_of_[p];
    matrix.Reduce(column.force_N(), columns_.col(taut + load_of_[p]));
  }
  lengths_.resize(static_cast<size_t>(model_.CableCount()));
  angles_.clear();
  for (int c = 0; c < model_.CableCount(); ++c) {
    FillRow(c, point_.path(c).length_gradient(), &lengths_[static_cast<size_t>(c)]);
    if (Rubs(c)) AddFrictionColumns(c);
  }
}

/// K gains A_i B_i' for each turn i: B_i = dangle/dx, and A_i = -T dforce/dangle.
void SensitivitySolver::AddFrictionColumns(int cable) {
  const Eigen::Index first = static_cast<Eigen::Index>(taut_.size()) + loads_;
  for (int turn = 0; turn < point_.path(cable).TurnCount(); ++turn) {
    point_.path(cable).Turn(turn, &turn_force_, &turn_angle_);
    turn_column_.Reset(nodal_.size(), model_.CableCount());
    point_.PullPath(cable, -point_.tension_N(cable), turn_force_, &turn_column_);
    model_.linearisation().matrix().Reduce(
        turn_column_.force_N(), columns_.col(first + static_cast<Eigen::Index>(angles_.size())));
    FillRow(cable, turn_angle_, &angles_.emplace_back());
  }
}

/// The row over free nodes of a function of the path's points, from its derivative [3 x points].
void SensitivitySolver::FillRow(int cable, const Eigen::Matrix3Xd& per_point, NodalRow* row) const {
  row->entries.clear();
  const std::vector<fem::NodeWeights>& eyelets = model_.cable(cable).eyelets();
  for (size_t e = 0; e < eyelets.size(); ++e) {
    for (size_t k = 0; k < eyelets[e].nodes.size(); ++k) {
      const int free_node = model_.linearisation().matrix().FreeIndex(eyelets[e].nodes[k]);
      if (free_node < 0) continue;
      row->entries.emplace_back(
          free_node, eyelets[e].weights[k] * per_point.col(static_cast<Eigen::Index>(e) + 1));
    }
  }
}

/// (K + A B')^-1 y = z - Z (I + B' Z)^-1 B' z with z = K^-1 y and Z = K^-1 A.
Status SensitivitySolver::CoupleFriction() {
  if (turns_ == 0) return Status::Ok();
  const Eigen::Index others = static_cast<Eigen::Index>(taut_.size()) + loads_;
  const auto Z = columns_.middleCols(others, turns_);
  Eigen::MatrixXd coupling = Eigen::MatrixXd::Identity(turns_, turns_);
  Eigen::MatrixXd angles(turns_, others);
  for (Eigen::Index i = 0; i < turns_; ++i) {
    const NodalRow& B = angles_[static_cast<size_t>(i)];
    for (Eigen::Index j = 0; j < turns_; ++j) coupling(i, j) += B.Dot(Z.col(j));
    for (Eigen::Index j = 0; j < others; ++j) angles(i, j) = B.Dot(columns_.col(j));
  }
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(coupling);
  constexpr double kSingular = 1e-12;
  if (!(lu.rcond() >= kSingular)) {
    return {StatusCode::kUnobservable, "friction leaves the equilibrium undetermined"};
  }
  columns_.leftCols(others).noalias() -= Z * lu.solve(angles);
  return Status::Ok();
}

Status SensitivitySolver::EliminateTautCables() {
  const auto taut = static_cast<Eigen::Index>(taut_.size());
  const Eigen::Index cables = model_.CableCount();
  const Eigen::Index count = ParameterCount();
  length_m_.resize(cables, count);
  tension_N_.resize(cables, count);
  for (Eigen::Index p = 0; p < count; ++p) {
    tension_N_.col(p) = columns_of_[static_cast<size_t>(p)].commanded_tension_N;
  }
  for (Eigen::Index c = 0; c < cables; ++c) {
    const NodalRow& row = lengths_[static_cast<size_t>(c)];
    for (Eigen::Index p = 0; p < count; ++p) {
      const int load = load_of_[static_cast<size_t>(p)];
      length_m_(c, p) = columns_of_[static_cast<size_t>(p)].length_m[c] +
                        (load < 0 ? 0.0 : row.Dot(columns_.col(taut + load)));
    }
  }
  if (taut == 0) return Status::Ok();

  fem::QpMatrix per_tension(cables, taut);  // dlength/dtension
  fem::QpMatrix W(taut, taut);
  for (Eigen::Index t = 0; t < taut; ++t) {
    for (Eigen::Index c = 0; c < cables; ++c) {
      per_tension(c, t) = lengths_[static_cast<size_t>(c)].Dot(columns_.col(t));
    }
  }
  for (Eigen::Index t = 0; t < taut; ++t) W.row(t) = per_tension.row(taut_[static_cast<size_t>(t)]);
  const Eigen::PartialPivLU<fem::QpMatrix> lu(W);
  constexpr double kAlike = 1e-12;  // rounding may leave a singular matrix its factor
  if (!(lu.rcond() >= kAlike)) return {StatusCode::kUnobservable, "two taut cables act alike"};
  for (Eigen::Index p = 0; p < count; ++p) {
    fem::QpVector wanted(taut);
    for (Eigen::Index t = 0; t < taut; ++t) {
      const int c = taut_[static_cast<size_t>(t)];
      wanted[t] = columns_of_[static_cast<size_t>(p)].commanded_length_m[c] - length_m_(c, p);
    }
    const fem::QpVector tension = lu.solve(wanted);
    length_m_.col(p).noalias() += per_tension.lazyProduct(tension);
    for (Eigen::Index t = 0; t < taut; ++t) {
      tension_N_(taut_[static_cast<size_t>(t)], p) = tension[t];
    }
  }
  return Status::Ok();
}

void SensitivitySolver::PointMotions(std::span<const fem::NodeWeights> points,
                                     Eigen::MatrixXd* motions_m) const {
  const auto taut = static_cast<Eigen::Index>(taut_.size());
  motions_m->setZero(static_cast<Eigen::Index>(3 * points.size()), ParameterCount());
  for (size_t e = 0; e < points.size(); ++e) {
    const auto row = static_cast<Eigen::Index>(3 * e);
    for (size_t k = 0; k < points[e].nodes.size(); ++k) {
      const int node = points[e].nodes[k];
      const int free_node = model_.linearisation().matrix().FreeIndex(node);
      for (Eigen::Index p = 0; p < ParameterCount(); ++p) {
        const ParameterColumn& column = columns_of_[static_cast<size_t>(p)];
        Eigen::Vector3d moved = Eigen::Vector3d::Zero();
        if (column.HasHeldMotion()) moved = column.held_motion_m().segment<3>(3 * node);
        if (free_node >= 0) {
          const int load = load_of_[static_cast<size_t>(p)];
          if (load >= 0) moved += columns_.col(taut + load).segment<3>(3 * free_node);
          for (Eigen::Index t = 0; t < taut; ++t) {
            moved += tension_N_(taut_[static_cast<size_t>(t)], p) *
                     columns_.col(t).segment<3>(3 * free_node);
          }
        }
        motions_m->col(p).segment<3>(row) += points[e].weights[k] * moved;
      }
    }
  }
}

Eigen::Matrix3Xd SensitivitySolver::PointMotion(const fem::NodeWeights& point) const {
  Eigen::MatrixXd motion_m;
  PointMotions({&point, 1}, &motion_m);
  return motion_m;
}

void SensitivitySolver::NodalMotion(int parameter, Eigen::VectorXd* motion_m) const {
  PALPATE_CHECK(parameter >= 0 && parameter < ParameterCount(), parameter);
  const auto taut = static_cast<Eigen::Index>(taut_.size());
  const fem::StiffnessMatrix& matrix = model_.linearisation().matrix();
  const ParameterColumn& column = columns_of_[static_cast<size_t>(parameter)];
  motion_m->setZero(point_.x_m().size());
  if (column.HasHeldMotion()) *motion_m = column.held_motion_m();
  const int load = load_of_[static_cast<size_t>(parameter)];
  if (load >= 0) matrix.AddExpanded(columns_.col(taut + load), 1.0, *motion_m);
  for (Eigen::Index t = 0; t < taut; ++t) {
    matrix.AddExpanded(columns_.col(t), tension_N_(taut_[static_cast<size_t>(t)], parameter),
                       *motion_m);
  }
}

}  // namespace palpate::robot
