// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/calibration/joint/ipopt_solver.hpp"
#include "components/calibration/joint/joint_problem.hpp"
#include "libs/core/status.hpp"

namespace palpate::calibration {

/// How variables and shapes were brought near the solution.
struct LiftedSolution {
  Status status;  ///< not ok: it led nowhere, and the problem is as it was
  Eigen::VectorXd variables;
  std::vector<double> objectives;            ///< of the start and after each step
  std::vector<double> residual_rms_after_m;  ///< of all frames, of the same
  int steps = 0;
  int factorisations = 0;  ///< for each frame: of the steps that were not chord steps
};

/// Shapes and variables move together: Newton's step of each frame's equilibrium and Gauss-Newton's
/// of the variables are of one linearisation (the lifted Newton method, Albersmeyer and Diehl,
/// SIAM J. Optim. 20(3), 2010), so that on the way no equilibrium is solved for variables that are
/// still far off. Bounds, beliefs, the camera's turn and robust weights count in each step as they
/// are (Ipopt): only the bodies' motion is linear. It ends where steps are tiny and every frame is
/// in balance to the static solver's tolerance. Not for problems with conditions.
LiftedSolution SolveLiftedGaussNewton(JointProblem* problem, const LeastSquaresSettings& settings);

}  // namespace palpate::calibration
