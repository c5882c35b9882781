// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/sensitivity.hpp"

#include <Eigen/Cholesky>

namespace palpate::robot {

namespace {

std::vector<int> TautCables(const std::vector<CableCommand>& cables,
                            const fem::StaticState& state) {
  std::vector<int> taut;
  for (size_t c = 0; c < cables.size(); ++c) {
    if (cables[c].kind == CableCommand::Kind::kDisplacement &&
        state.multipliers_N[static_cast<Eigen::Index>(c)] > 0.0) {
      taut.push_back(static_cast<int>(c));
    }
  }
  return taut;
}

}  // namespace

Status EquilibriumSensitivity(RobotModel& model, const std::vector<CableCommand>& cables,
                              const fem::StaticState& state,
                              const Eigen::MatrixXd& force_derivative_N, Eigen::MatrixXd* dx_dp) {
  fem::Linearisation& linearisation = model.linearisation();
  Status status =
      linearisation.Update(state.x_m, state.multipliers_N, state.loads.external_force_N);
  if (!status.ok()) return status;
  const std::vector<int> taut = TautCables(cables, state);
  const auto t = static_cast<Eigen::Index>(taut.size());
  const Eigen::Index p = force_derivative_N.cols();
  Eigen::MatrixXd columns(linearisation.Size(), t + p);
  for (Eigen::Index i = 0; i < t; ++i) {
    Eigen::VectorXd nodal = Eigen::VectorXd::Zero(state.x_m.size());
    model.cable(taut[static_cast<size_t>(i)]).AddGradient(state.x_m, -1.0, nodal);
    linearisation.matrix().Reduce(nodal, columns.col(i));
  }
  for (Eigen::Index j = 0; j < p; ++j) {
    linearisation.matrix().Reduce(force_derivative_N.col(j), columns.col(t + j));
  }
  const Eigen::MatrixXd H_a = columns.leftCols(t);
  linearisation.Solve(columns);
  if (t > 0) {
    const Eigen::MatrixXd W_aa = H_a.transpose() * columns.leftCols(t);
    const Eigen::LLT<Eigen::MatrixXd> factor(W_aa);
    constexpr double kAlike = 1e-12;  // rounding may leave a singular matrix its factor
    if (factor.info() != Eigen::Success || factor.rcond() < kAlike) {
      return {StatusCode::kUnobservable, "two taut cables act alike"};
    }
    const Eigen::MatrixXd tension = -factor.solve(H_a.transpose() * columns.rightCols(p));
    columns.rightCols(p) += columns.leftCols(t) * tension;
  }
  dx_dp->setZero(state.x_m.size(), p);
  for (Eigen::Index j = 0; j < p; ++j) {
    linearisation.matrix().AddExpanded(columns.col(t + j), 1.0, dx_dp->col(j));
  }
  return Status::Ok();
}

}  // namespace palpate::robot
