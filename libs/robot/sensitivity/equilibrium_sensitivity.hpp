// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/core/status.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::robot {

/// How an equilibrium moves with parameters p: dx/dp [3n x p], for `force_derivative_N` [3n x p],
/// the derivative of f_ext - F_int with respect to p at fixed x. Taut cables under displacement
/// control keep their length, so that their tension changes; slack ones and those under force
/// control take no part. SensitivitySolver with NodalForce parameters, dense.
/// Not ok where K has no factor at the state, or two taut cables are collinear (kUnobservable);
/// `dx_dp` is then left empty.
Status EquilibriumSensitivity(RobotModel& model, const std::vector<ActuatorCommand>& cables,
                              const fem::StaticState& state,
                              const Eigen::MatrixXd& force_derivative_N, Eigen::MatrixXd* dx_dp);

}  // namespace palpate::robot
