// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

namespace palpate::correspondence {

/// Mean of values with errors, that some wrong ones among them do not move.
class RobustMean {
 public:
  /// Lowers `weight` [n] (>= 0) by Tukey's biweight of the distance from the mean, counted in
  /// sigmas; where the values scatter more than `sigma` says (a patch that bends), in those of
  /// their own scatter. Starts from the median, so that less than half of the values can be wrong.
  void LowerWeights(const Eigen::Ref<const Eigen::VectorXd>& value,
                    const Eigen::Ref<const Eigen::VectorXd>& sigma,
                    Eigen::Ref<Eigen::VectorXd> weight);

 private:
  double MedianOf(const Eigen::Ref<const Eigen::VectorXd>& value,
                  const Eigen::Ref<const Eigen::VectorXd>& weight);

  std::vector<double> sorted_;
  Eigen::VectorXd lowered_;
};

}  // namespace palpate::correspondence
