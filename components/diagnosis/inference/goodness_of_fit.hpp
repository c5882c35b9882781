// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>

#include "components/diagnosis/inference/fitter.hpp"

namespace palpate::diagnosis {

/// Whether what a fit leaves over is what noise and belief would leave.
struct GoodnessOfFit {
  bool passed = false;
  double surprise = 0.0;  ///< the worst test, in standard deviations of what a right model leaves
  std::string worst;      ///< "misfit of recording RH_hold", "runs in recording RB_repeat", ...
  double surprise_limit = 0.0;  ///< up to which it may be noise
  double excess = 0.0;  ///< how far the worst test is off, as a share of its recording's noise
};

/// ResidualStatistics of the residual, compared with what `draws` experiments of the fitted model
/// leave (parametric bootstrap, seeded), the worst of all tests with the worst of each draw.
/// `marker_rest_m` [3 x markers]: of the undeformed body.
GoodnessOfFit TestGoodnessOfFit(const ObservedExperiment& observed,
                                const Eigen::Matrix3Xd& marker_rest_m,
                                const HypothesisSet& hypotheses, const Fit& fit, int draws = 200,
                                std::uint64_t seed = 1);

}  // namespace palpate::diagnosis
