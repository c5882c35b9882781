// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/diagnosis/inference/fitter.hpp"

namespace palpate::diagnosis {

/// Bayesian model averaging. A fault whose place or time constant is unknown has several fault
/// models of one name, each with a prior near its own place; a hypothesis holds one of them.

/// A complete fit with `fault`, or with the same fault at a place of clearly larger evidence;
/// `*fault` is the number there.
Fit AtTheBestPlace(const Fitter& fitter, Fit fit, int* fault);

/// Covariance [parameters of `fault`] of a complete fit about its mean, averaged over all places of
/// the fault with their evidence as weight, by the linear model about the fit.
Eigen::MatrixXd CovarianceOverPlaces(const Fitter& fitter, const Fit& fit, int fault);

/// A further fault that has some evidence, but not enough to be named.
struct FurtherFault {
  int fault = -1;
  double weight = 0.0;  ///< its probability over that of none; at most 1
  Posterior posterior;  ///< of all parameters, with it
};

/// Further faults of sufficient weight beside those of a complete fit, by the linear model about
/// it. Half of the prior weight is on none (Choice::probability).
std::vector<FurtherFault> FurtherFaults(const Fitter& fitter, const Fit& fit);

/// Covariance [parameters of `fault`] about its mean in `fit`, averaged over the hypothesis without
/// a further fault, where it is `without`, and those with each of `further`.
Eigen::MatrixXd CovarianceOverFurtherFaults(const HypothesisSet& hypotheses, const Fit& fit,
                                            int fault, const std::vector<FurtherFault>& further,
                                            const Eigen::MatrixXd& without);

}  // namespace palpate::diagnosis
