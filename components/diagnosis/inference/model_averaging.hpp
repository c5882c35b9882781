// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/diagnosis/inference/fitter.hpp"

namespace palpate::diagnosis {

/// A fault that is unknown the place (or time constant) of stands in the hypothesis set once for
/// each that it is searched at: one name, parameters that count from there. Each is assumed a
/// priori to be near its own place, and they are fitted one at a time; these two see to it that the
/// others count, too.

/// A complete fit with `fault`, or one in which it stands at a place that fits clearly better, as
/// far as one can be reached; `*fault` is where it stands then.
Fit AtTheBestPlace(const Fitter& fitter, Fit fit, int* fault);

/// Covariance [parameters of `fault`] of a complete fit, about its mean, over all places of the
/// fault, each as probable as it makes the data: where these do not tell one from another, the
/// interval that they leave is as wide as the places lie apart. Elsewhere the fault counts as
/// linear models about the fit have it.
Eigen::MatrixXd CovarianceOverPlaces(const Fitter& fitter, const Fit& fit, int fault);

/// A fault that the data leave open beside those that a fit has: there is evidence for it, if none
/// that is clear enough to name it.
struct FurtherFault {
  int fault = -1;
  double weight = 0.0;  ///< how probable it is, over that there is none; at most 1
  Posterior posterior;  ///< of all parameters, with it
};

/// Those that are of weight beside the faults of a complete fit, by the linear model about it. Half
/// of what is assumed a priori before is that there is none (Choice::probability).
std::vector<FurtherFault> FurtherFaults(const Fitter& fitter, const Fit& fit);

/// Covariance [parameters of `fault`] about its mean in `fit`, over robots without a further fault,
/// where it is `without`, and with each of `further`: what one of these would make of the
/// parameters, their interval has to hold.
Eigen::MatrixXd CovarianceOverFurtherFaults(const HypothesisSet& hypotheses, const Fit& fit,
                                            int fault, const std::vector<FurtherFault>& further,
                                            const Eigen::MatrixXd& without);

}  // namespace palpate::diagnosis
