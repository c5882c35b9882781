// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/calibration/joint/ipopt_solver.hpp"
#include "components/calibration/joint/joint_problem.hpp"
#include "libs/core/status.hpp"

namespace palpate::calibration {

/// Result of the lifted Gauss-Newton method.
struct LiftedSolution {
  Status status;  ///< not ok: not converged, and the problem is unchanged
  Eigen::VectorXd variables;
  std::vector<double> objectives;            ///< at the start and after each step
  std::vector<double> residual_rms_after_m;  ///< of all frames, likewise
  int steps = 0;
  int factorisations = 0;  ///< per frame: steps that were no chord steps
};

/// Shapes and variables move together: the Newton step of each equilibrium and the Gauss-Newton
/// step of the variables share one linearisation (lifted Newton method, Albersmeyer and Diehl, SIAM
/// J. Optim. 20(3), 2010), so that no equilibrium is solved far from the solution. Only the motion
/// of the bodies is linearised: bounds, priors, camera rotation and robust weights are exact in
/// each step. It ends where steps are tiny and every frame is in equilibrium to the static solver's
/// tolerance. Not for problems with conditions.
LiftedSolution SolveLiftedGaussNewton(JointProblem* problem, const LeastSquaresSettings& settings);

}  // namespace palpate::calibration
