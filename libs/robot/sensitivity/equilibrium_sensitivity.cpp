// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/sensitivity/equilibrium_sensitivity.hpp"

#include "libs/robot/sensitivity/parameters.hpp"
#include "libs/robot/sensitivity/sensitivity_solver.hpp"

namespace palpate::robot {

Status EquilibriumSensitivity(RobotModel& model, const std::vector<ActuatorCommand>& cables,
                              const fem::StaticState& state,
                              const Eigen::MatrixXd& force_derivative_N, Eigen::MatrixXd* dx_dp) {
  std::vector<ParameterPtr> parameters;
  for (Eigen::Index p = 0; p < force_derivative_N.cols(); ++p) {
    parameters.push_back(NodalForce(force_derivative_N.col(p)));
  }
  SensitivitySolver solver(model);
  Status status = solver.Compute(cables, state, parameters);
  if (!status.ok()) {
    dx_dp->resize(0, 0);
    return status;
  }
  dx_dp->resize(state.x_m.size(), force_derivative_N.cols());
  Eigen::VectorXd motion;
  for (int p = 0; p < solver.ParameterCount(); ++p) {
    solver.NodalMotion(p, &motion);
    dx_dp->col(p) = motion;
  }
  return status;
}

}  // namespace palpate::robot
