// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>

#include "components/calibration/joint/joint_problem.hpp"

namespace palpate::calibration {

bool IsOfPose(int variable, const JointProblem& problem);

/// A variable that the data do not determine, and the scaled standard deviation that they leave.
struct UndeterminedVariable {
  int variable = -1;
  double sigma = 0.0;
};

/// The free variable with the largest posterior standard deviation, where that exceeds `share` of
/// its prior or plausible change; a pose variable only where no other does, and never one with a
/// prior. The posterior is joint:
/// two parameters of which only the sum is observable both exceed it until one is held.
/// Also a coefficient of the depth bias whose total error, considered parameters included, exceeds
/// its prior.
std::optional<UndeterminedVariable> MostUndetermined(const LeastSquaresPoint& point,
                                                     const JointProblem& problem, double share);

/// The free modulus with the largest total error (CovarianceOf) where that exceeds `share` of its
/// prior: a small force tells a modulus only as well as the model and the pose are known.
std::optional<UndeterminedVariable> MostUncertainModulus(const LeastSquaresPoint& point,
                                                         const JointProblem& problem,
                                                         double huber_threshold, double share);

/// Rows of the data minus free variables without a prior.
int DegreesOfFreedom(const JointProblem& problem);

/// A solution with its robust weights.
struct WeightedFit {
  Eigen::MatrixXd information;  ///< [variables x variables] J' w J, priors included
  double chi_squared = 0.0;     ///< of the data's rows, weighted
};
WeightedFit Weigh(const JointProblem& problem, const LeastSquaresPoint& point,
                  double huber_threshold);

/// Birge's ratio: at least 1.
double WidenedBy(const WeightedFit& fit, int degrees_of_freedom);

/// [variables x variables] covariance of the errors (estimate minus truth): of estimated variables
/// the inverse information times `widened`, plus the effect of held ones (Schmidt 1966, consider
/// covariance). Held variables have their prior covariance; without a prior they count as known.
///
/// Against::kThisModel leaves out errors of the model itself, which recur wherever this model is
/// aligned with this robot.
enum class Against { kTruth, kThisModel };
Eigen::MatrixXd CovarianceOf(const WeightedFit& fit, const JointProblem& problem, double widened,
                             Against against = Against::kTruth);

}  // namespace palpate::calibration
