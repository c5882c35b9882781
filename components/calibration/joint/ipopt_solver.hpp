// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <atomic>
#include <stop_token>
#include <string>
#include <vector>

#include "components/calibration/joint/least_squares_problem.hpp"
#include "libs/core/status.hpp"

namespace palpate::calibration {

struct LeastSquaresSettings {
  int max_iterations = 100;
  /// Converged where no variable moves further in a step, and constraint violation and barrier
  /// parameter are no larger.
  double step_tolerance = 1e-8;
  /// Huber's threshold of a block, in standard deviations; <= 0: no robust loss.
  double huber_threshold = 0.0;
  /// The start is nearly the solution and is not pushed away from its bounds.
  bool starts_there = false;
  /// Checked after each iteration: ends with kNotConverged.
  std::stop_token stop = {};
  /// Counts the iterations of all solutions, where it is given; read from another thread.
  std::atomic<int>* iterations = nullptr;
};

struct LeastSquaresSolution {
  Status status;
  Eigen::VectorXd variables;
  LeastSquaresPoint point;         ///< at `variables`
  std::vector<double> objectives;  ///< of the start and after each iteration
  int iterations = 0;
  std::string failed_evaluation;  ///< reason of the last point without a value
};

/// Solves it with Ipopt (interior point, line search with filter) and the Gauss-Newton Hessian
/// J' w J. kNotConverged where Ipopt does not report a solution; `variables` are then the last
/// iterate.
LeastSquaresSolution SolveLeastSquares(LeastSquaresProblem& problem,
                                       const LeastSquaresSettings& settings);

}  // namespace palpate::calibration
