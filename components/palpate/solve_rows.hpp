// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>
#include <string>
#include <vector>

#include "components/palpate/load_cases.hpp"
#include "libs/fem/static_solver.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::command {

/// The result of one row.
struct RowResult {
  int row = 0;
  double t_s = 0.0;
  fem::StaticResult solver;
  double time_s = 0.0;                          ///< wall clock
  Eigen::VectorXd x_m;                          ///< [3n]; empty where it did not converge
  std::vector<robot::ActuatorState> actuators;  ///< empty where it did not converge
  std::vector<robot::DeadLoad> loads;
  std::vector<std::string> notes;  ///< slack cables, chambers at a vacuum

  bool converged() const { return solver.status.ok(); }
};

/// "north 5.000 mm 1.250 N", "tip 350.0 mm3 12.00 kPa".
std::string ActuatorText(const robot::ActuatorTraits& traits, const robot::ActuatorState& state);

/// Called at the start of a row and before each of its Newton iterations with the result so far.
/// Returns false to give the row up.
using WatchRow = std::function<bool(int row, const fem::StaticResult& so_far)>;

/// Solves one row after the other, each from the state before it (the first from rest), and hands
/// each result to `take`. A row that fails does not stop the others. Where `watch` gives up, the
/// row that is being solved is not taken, nor are those after it. Returns whether all rows were
/// taken. Throws InputError at the line of a load that lies farther from the body than half the
/// body's diagonal.
bool SolveRows(const std::vector<LoadCase>& rows, robot::RobotModel* model,
               const std::function<void(const RowResult&)>& take, const WatchRow& watch);

/// Notes on loads that do not lie on the surface.
std::vector<std::string> NotesOnLoads(const std::vector<LoadCase>& rows,
                                      const robot::RobotModel& model);

}  // namespace palpate::command
