// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <stop_token>
#include <string>
#include <vector>

#include "components/calibration/joint/least_squares_problem.hpp"
#include "libs/core/status.hpp"

namespace palpate::calibration {

struct LeastSquaresSettings {
  int max_iterations = 100;
  /// It has arrived where no variable moves further in a step, constraints are met as well, and the
  /// barrier that keeps it from the bounds has shrunk as far.
  double step_tolerance = 1e-8;
  /// Blocks weigh less beyond so many sigmas; <= 0: all weigh alike.
  double huber_threshold = 0.0;
  /// The start is the solution but for tiny steps: it is not pushed away from its bounds.
  bool starts_there = false;
  /// Asked after each iteration: it then ends there, kNotConverged.
  std::stop_token stop = {};
};

struct LeastSquaresSolution {
  Status status;
  Eigen::VectorXd variables;
  LeastSquaresPoint point;         ///< at `variables`
  std::vector<double> objectives;  ///< of the start and after each iteration
  int iterations = 0;
  std::string failed_evaluation;  ///< why the last point without a value had none
};

/// Solves it with Ipopt (interior point, line search with filter); the Hessian is J' w J
/// (Gauss-Newton: exact where residuals vanish). kNotConverged where Ipopt says anything but
/// "solved"; `variables` are then where it stopped.
LeastSquaresSolution SolveLeastSquares(LeastSquaresProblem& problem,
                                       const LeastSquaresSettings& settings);

}  // namespace palpate::calibration
