// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/robust_loss.hpp"
#include "libs/core/statistics.hpp"

namespace palpate::calibration {

RobustLoss LossOf(const Eigen::VectorXd& residual, const std::vector<RobustBlock>& blocks,
                  double huber_threshold) {
  RobustLoss loss;
  loss.weights.setOnes(residual.size());
  loss.objective = 0.5 * residual.squaredNorm();
  for (const RobustBlock& block : blocks) {
    const double norm = residual.segment(block.first_row, block.rows).norm();
    const double weight = HuberWeight(norm, huber_threshold);
    if (weight == 1.0) continue;
    loss.weights.segment(block.first_row, block.rows).setConstant(weight);
    loss.objective += huber_threshold * (norm - 0.5 * huber_threshold) - 0.5 * norm * norm;
  }
  return loss;
}

}  // namespace palpate::calibration
