// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/calibration/joint/ipopt_solver.hpp"
#include "components/calibration/joint/least_squares_problem.hpp"

namespace palpate::calibration {

/// Minimises a problem that is cheap to evaluate within its bounds, by projected Gauss-Newton steps
/// that are halved until the objective falls (Bertsekas, SIAM J. Control Optim. 20(2), 1982).
/// Constraints are ignored. It ends like SolveLeastSquares, or where no step lowers the objective;
/// kNotConverged where neither happens, or the start has no value.
LeastSquaresSolution SolveWithinBounds(LeastSquaresProblem& problem,
                                       const LeastSquaresSettings& settings);

}  // namespace palpate::calibration
