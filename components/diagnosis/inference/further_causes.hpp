// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/diagnosis/inference/fitter.hpp"

namespace palpate::diagnosis {

/// A cause that the data leave open beside those that a fit has: there is evidence for it, if none
/// that is clear enough to name it.
struct FurtherCause {
  int cause = -1;
  double weight = 0.0;  ///< how probable it is, over that there is none; at most 1
  Posterior posterior;  ///< of all parameters, with it
};

/// Those that are of weight beside the faults of a complete fit, by the linear model about it. Half
/// of what is believed before is that there is none (Choice::probability).
std::vector<FurtherCause> FurtherCauses(const Fitter& fitter, const Fit& fit);

/// Covariance [parameters of `cause`] about its mean in `fit`, over robots without a further cause,
/// where it is `without`, and with each of `further`: what one of these would make of the
/// parameters, their interval has to hold.
Eigen::MatrixXd CovarianceBeside(const HypothesisSet& hypotheses, const Fit& fit, int cause,
                                 const std::vector<FurtherCause>& further,
                                 const Eigen::MatrixXd& without);

}  // namespace palpate::diagnosis
