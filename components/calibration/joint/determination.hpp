// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>

#include "components/calibration/joint/joint_problem.hpp"

namespace palpate::calibration {

bool IsOfPose(int variable, const JointProblem& problem);

/// The variable that is free and that these data leave most uncertain, where that is more than
/// `share` of what was believed or is plausible; those of the pose only where no other is. As for
/// all in common: two numbers of which only the sum shows are both uncertain until one is held.
/// Also a coefficient of the depth bias whose error, with what is considered, is more than what was
/// believed: left at its mean it does less harm.
std::optional<int> MostUndetermined(const LeastSquaresPoint& point, const JointProblem& problem,
                                    double share);

/// A solution with its robust weights.
struct WeightedFit {
  Eigen::MatrixXd information;  ///< [variables x variables] J' w J, with the beliefs'
  double chi_squared = 0.0;     ///< of the data's rows, weighted
};
WeightedFit Weigh(const JointProblem& problem, const LeastSquaresPoint& point,
                  double huber_threshold);

/// [variables x variables] of the errors (found - true) of the variables: of those that were
/// estimated from the information, times `widened`, and from what held ones shift them by (Schmidt
/// 1966: considered). Held ones err by what is believed of them; with nothing believed they count
/// as known, and have 0.
///
/// Against::kThisModel leaves out what the model's own errors shift them by: where it is laid on
/// the robot as it was here, they are there again.
enum class Against { kTruth, kThisModel };
Eigen::MatrixXd CovarianceOf(const WeightedFit& fit, const JointProblem& problem, double widened,
                             Against against = Against::kTruth);

}  // namespace palpate::calibration
