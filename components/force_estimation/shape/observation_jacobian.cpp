// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/observation_jacobian.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/linalg/cholesky.hpp"

namespace palpate::force_estimation {

namespace {

/// The taut cables: their gradients, the response to their tension, and the constraint of their
/// length.
struct TautCables {
  Eigen::MatrixXd pull;    ///< [reduced x taut] rows of H_a
  Eigen::MatrixXd motion;  ///< K^-1 pull
  std::optional<linalg::Cholesky> compliance;

  Status Solve(robot::RobotModel& model, const Eigen::VectorXd& x_m,
               const std::vector<robot::ActuatorCommand>& commands,
               const Eigen::VectorXd& lambda_a_N) {
    std::vector<int> taut;
    for (int c = 0; c < model.ActuatorCount(); ++c) {
      const bool driven = commands[At(c)].kind == robot::ActuatorCommand::Kind::kDisplacement;
      if (driven && lambda_a_N[c] > model.traits(c).least_force_N) taut.push_back(c);
    }
    fem::Linearisation& linearisation = model.linearisation();
    pull.setZero(linearisation.Size(), ToIndex(taut.size()));
    if (taut.empty()) return Status::Ok();
    Eigen::VectorXd nodal(x_m.size());
    for (size_t t = 0; t < taut.size(); ++t) {
      nodal.setZero();
      model.actuator(taut[t]).AddGradient(x_m, -1.0, nodal);
      linearisation.matrix().Reduce(nodal, pull.col(ToIndex(t)));
    }
    motion = pull;
    linearisation.SolveSingle(motion);
    compliance.emplace(pull.transpose() * motion);
    if (!compliance->ok()) {
      return {StatusCode::kUnobservable,
              "cable Jacobian is rank deficient: two taut cables are collinear"};
    }
    return Status::Ok();
  }

  /// Adds to each column the motion by which the cables keep their length.
  void Hold(Eigen::Ref<Eigen::MatrixXd> columns) const {
    if (pull.cols() == 0) return;
    const Eigen::MatrixXd tension = compliance->Solve(Eigen::MatrixXd(pull.transpose() * columns));
    columns.noalias() -= motion * tension;
  }
};

/// Rows that are eliminated close to one another are solved for together: they skip most of the
/// factor.
std::vector<size_t> OrderOfElimination(const std::vector<robot::ObservationRow>& rows,
                                       const fem::StiffnessMatrix& matrix) {
  std::vector<int> first(rows.size(), std::numeric_limits<int>::max());
  for (size_t i = 0; i < rows.size(); ++i) {
    for (const int node : rows[i].nodes) {
      const int free = matrix.FreeIndex(node);
      if (free >= 0) first[i] = std::min(first[i], free);
    }
  }
  std::vector<size_t> order(rows.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return first[a] < first[b]; });
  return order;
}

}  // namespace

Status ObservationJacobian::Add(robot::RobotModel& model,
                                const std::vector<robot::ObservationRow>& rows,
                                const Eigen::VectorXd& x_m,
                                const std::vector<robot::ActuatorCommand>& commands,
                                const Eigen::VectorXd& lambda_a_N) {
  PALPATE_CHECK(static_cast<int>(commands.size()) == model.ActuatorCount(), commands.size());
  PALPATE_CHECK(lambda_a_N.size() == model.ActuatorCount(), lambda_a_N.size());
  fem::Linearisation& linearisation = model.linearisation();
  const fem::StiffnessMatrix& matrix = linearisation.matrix();
  TautCables cables;
  Status status = cables.Solve(model, x_m, commands, lambda_a_N);
  if (!status.ok()) return status;
  const auto count = ToIndex(rows.size());
  Eigen::MatrixXd columns(linearisation.Size(), count);
  Eigen::VectorXd nodal(x_m.size());
  const std::vector<size_t> order = OrderOfElimination(rows, matrix);
  for (Eigen::Index i = 0; i < count; ++i) {
    const robot::ObservationRow& row = rows[order[At(i)]];
    nodal.setZero();
    for (size_t k = 0; k < row.nodes.size(); ++k) {
      nodal.segment<3>(3 * row.nodes[k]) += row.coefficients[k];
    }
    matrix.Reduce(nodal, columns.col(i));
  }
  linearisation.SolveSingle(columns);  // which leaves less than 1e-6 of them
  cables.Hold(columns);
  if (!columns.allFinite()) return {StatusCode::kInvalidInput, "a response is not finite"};
  free_index_.resize(static_cast<size_t>(matrix.NodeCount()));
  for (int node = 0; node < matrix.NodeCount(); ++node) {
    free_index_[At(node)] = matrix.FreeIndex(node);
  }
  const Eigen::Index before = columns_.cols();
  columns_.conservativeResize(columns.rows(), before + count);
  for (Eigen::Index r = 0; r < columns.rows(); ++r) {
    for (Eigen::Index i = 0; i < count; ++i) {
      columns_(r, before + ToIndex(order[At(i)])) = columns(r, i);
    }
  }
  ++version_;
  return status;
}

void ObservationJacobian::Clear() {
  columns_.resize(0, 0);
  ++version_;
}

Eigen::MatrixX3d ObservationJacobian::To(const fem::InterpolationWeights& place) const {
  Eigen::MatrixX3d response = Eigen::MatrixX3d::Zero(columns_.cols(), 3);
  for (size_t k = 0; k < place.nodes.size(); ++k) {
    const int free = free_index_[At(place.nodes[k])];
    if (free < 0) continue;
    response.noalias() += place.weights[k] * columns_.middleRows<3>(3 * free).transpose();
  }
  return response;
}

}  // namespace palpate::force_estimation
