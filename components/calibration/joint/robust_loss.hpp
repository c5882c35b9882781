// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/calibration/joint/least_squares_problem.hpp"

namespace palpate::calibration {

/// Objective and weights of residuals with Huber's loss per block (HuberWeight of its norm).
struct RobustLoss {
  double objective = 0.0;   ///< LeastSquaresProblem's
  Eigen::VectorXd weights;  ///< [rows] gradient J' w r, Gauss-Newton's Hessian J' w J
};
RobustLoss LossOf(const Eigen::VectorXd& residual, const std::vector<RobustBlock>& blocks,
                  double huber_threshold);

}  // namespace palpate::calibration
