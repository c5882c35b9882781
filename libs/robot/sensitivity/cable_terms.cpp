// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/sensitivity/cable_terms.hpp"

#include <utility>

#include "libs/core/index.hpp"
#include "libs/linalg/lu.hpp"

namespace palpate::robot {

double NodalRow::Dot(const Eigen::Ref<const Eigen::VectorXd>& column) const {
  double sum = 0.0;
  for (const auto& [node, entry] : entries) sum += entry.dot(column.segment<3>(3 * node));
  return sum;
}

void NodalRow::AddTo(Eigen::Ref<Eigen::VectorXd> column) const {
  for (const auto& [node, entry] : entries) column.segment<3>(3 * node) += entry;
}

void CableTerms::Evaluate() {
  const RobotModel& model = point_.model();
  taut_.clear();
  angles_.clear();
  lengths_.resize(static_cast<size_t>(model.ActuatorCount()));
  for (int c = 0; c < model.ActuatorCount(); ++c) {
    if (point_.KeepsLength(c)) taut_.push_back(c);
    if (c >= model.CableCount()) {
      FillChamberRow(c, &lengths_[At(c)]);
      continue;
    }
    FillRow(c, point_.path(c).length_gradient(), &lengths_[At(c)]);
    if (!Rubs(c)) continue;
    for (int turn = 0; turn < point_.path(c).TurnCount(); ++turn) {
      point_.path(c).Turn(turn, &turn_force_, &turn_angle_);
      FillRow(c, turn_angle_, &angles_.emplace_back());
    }
  }
}

bool CableTerms::Rubs(int cable) const {
  return point_.tension_N(cable) > 0.0 && point_.model().cable(cable).friction().coefficient > 0.0;
}

void CableTerms::FillTurnForces(Eigen::Ref<Eigen::MatrixXd> columns) {
  Eigen::Index next = 0;
  for (int c = 0; c < point_.model().CableCount(); ++c) {
    if (!Rubs(c)) continue;
    for (int turn = 0; turn < point_.path(c).TurnCount(); ++turn) {
      point_.path(c).Turn(turn, &turn_force_, &turn_angle_);
      turn_column_.Reset(point_.x_m().size(), point_.model().ActuatorCount());
      point_.PullPath(c, -point_.tension_N(c), turn_force_, &turn_column_);
      nodal_.setZero(point_.x_m().size());
      turn_column_.AddForceTo(nodal_);
      point_.model().linearisation().matrix().Reduce(nodal_, columns.col(next++));
    }
  }
}

/// The row over free nodes of a function of the path's points, from its derivative [3 x points].
void CableTerms::FillRow(int cable, const Eigen::Matrix3Xd& per_point, NodalRow* row) const {
  row->entries.clear();
  const std::vector<fem::InterpolationWeights>& eyelets = point_.model().cable(cable).eyelets();
  for (size_t e = 0; e < eyelets.size(); ++e) {
    for (size_t k = 0; k < eyelets[e].nodes.size(); ++k) {
      const int free_node = point_.model().linearisation().matrix().FreeIndex(eyelets[e].nodes[k]);
      if (free_node < 0) continue;
      row->entries.emplace_back(free_node, eyelets[e].weights[k] * per_point.col(ToIndex(e) + 1));
    }
  }
}

void CableTerms::FillChamberRow(int actuator, NodalRow* row) {
  row->entries.clear();
  nodal_.setZero(point_.x_m().size());
  point_.model().actuator(actuator).AddGradient(point_.x_m(), 1.0, nodal_);
  for (int node = 0; 3 * node < nodal_.size(); ++node) {
    const int free_node = point_.model().linearisation().matrix().FreeIndex(node);
    const Eigen::Vector3d entry = nodal_.segment<3>(3 * node);
    if (free_node >= 0 && !entry.isZero(0.0)) row->entries.emplace_back(free_node, entry);
  }
}

Status CableTerms::HoldLengths(const fem::QpMatrix& per_tension,
                               const Eigen::MatrixXd& commanded_length_m, Eigen::MatrixXd* length_m,
                               Eigen::MatrixXd* tension_N) const {
  const Eigen::Index count = TautCount();
  if (count == 0) return Status::Ok();
  fem::QpMatrix W(count, count);
  for (Eigen::Index t = 0; t < count; ++t) {
    const int c = taut_[At(t)];
    W.row(t) = per_tension.row(c);
    W(t, t) -= point_.model().actuator(c).compliance_m_N();
  }
  const linalg::SmallLu lu(W);
  constexpr double kAlike = 1e-12;  // rounding may leave a singular matrix its factor
  if (!(lu.ReciprocalCondition() >= kAlike))
    return {StatusCode::kUnobservable, "two actuators have linearly dependent effects"};
  for (Eigen::Index p = 0; p < length_m->cols(); ++p) {
    fem::QpVector wanted(count);
    for (Eigen::Index t = 0; t < count; ++t) {
      const int c = taut_[At(t)];
      wanted[t] = commanded_length_m(c, p) - (*length_m)(c, p);
    }
    const fem::QpVector tension = lu.Solve(wanted);
    length_m->col(p).noalias() += per_tension.lazyProduct(tension);
    for (Eigen::Index t = 0; t < count; ++t) (*tension_N)(taut_[At(t)], p) = tension[t];
  }
  return Status::Ok();
}

Status UndoTurns(Eigen::MatrixXd coupling, Eigen::MatrixXd* right) {
  coupling.diagonal().array() += 1.0;
  const linalg::Lu lu(coupling);
  constexpr double kSingular = 1e-12;
  if (!(lu.ReciprocalCondition() >= kSingular)) {
    return {StatusCode::kUnobservable, "friction leaves the equilibrium undetermined"};
  }
  if (right->cols() > 0) *right = lu.Solve(std::move(*right));
  return Status::Ok();
}

}  // namespace palpate::robot
