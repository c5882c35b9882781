// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "libs/fem/static_solver.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::command {

/// What a small pull of one cable does, from the equilibrium under gravity.
struct PullTrial {
  std::string cable;
  Status status;        ///< of the equilibrium
  double pull_m = 0.0;  ///< pulled in beyond the equilibrium under gravity
  double tension_N = 0.0;
  Eigen::Vector3d tip_motion_m = Eigen::Vector3d::Zero();
  double largest_motion_m = 0.0;  ///< of any node
};

/// Whether a new robot can be computed with, and what its cables do.
struct RobotCheck {
  Status rest;                                      ///< under gravity alone
  double sag_m = 0.0;                               ///< largest motion under gravity
  Eigen::Vector3d tip_m = Eigen::Vector3d::Zero();  ///< the node farthest from the fixed region
  std::vector<PullTrial> pulls;
  double solve_s = 0.0;               ///< mean duration of one equilibrium
  std::vector<std::string> warnings;  ///< in words: what is likely wrong, and what to do

  bool cut_short = false;  ///< the time was up; what was not tried is no failure

  bool ok() const;  ///< all equilibria that were tried were found
};

/// How far the cables of a body are pulled to try them: a hundredth of its diagonal.
double TrialPull_m(const robot::RobotBody& body);

/// Takes at most about `most_s`.
RobotCheck CheckRobot(robot::RobotModel* model, double most_s);

}  // namespace palpate::command
