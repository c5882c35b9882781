// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "libs/fem/static_solver.hpp"
#include "python/bindings/patch.hpp"
#include "python/bindings/robot.hpp"

namespace palpate::python {

/// A static equilibrium of one robot, with what it was solved for.
struct Equilibrium {
  std::shared_ptr<Robot> robot;
  std::vector<robot::ActuatorCommand> commands;
  bool has_gas = false;  ///< in a chamber, so that `commands` do not hold for its derivatives
  fem::StaticState state;
  fem::StaticResult result;
  double time_s = 0.0;  ///< in C++, without the waiting for another thread
  Eigen::VectorXd tension_N, displacement_m, length_m;  ///< [cables]
  Eigen::Matrix3Xd markers_m;                           ///< [3 x markers]
};

/// What Robot.solve takes.
struct SolveRequest {
  CableValues displacement_m;
  CableValues tension_N;
  CableValues air_m3;  ///< pumped into closed chambers (robot::GasLaw)
  std::vector<Load> loads;
  std::shared_ptr<Equilibrium> start;  ///< null: the body at rest, without loads
  robot::CableInput preferred = robot::CableInput::kDisplacement;
};

/// Solves for the equilibrium. Throws InputError, SolveFailure, and what Ctrl-C raises.
std::shared_ptr<Equilibrium> Solve(const std::shared_ptr<Robot>& robot,
                                   const SolveRequest& request);

/// Throws InputError for an equilibrium with a chamber of given gas, whose derivatives are not
/// known.
void RequireNoGas(const Equilibrium& equilibrium);

/// Throws InputError unless the equilibrium is of this robot.
void RequireEquilibriumOf(const Robot& robot, const Equilibrium& equilibrium);

void BindEquilibrium(pybind11::module_& module);

}  // namespace palpate::python
