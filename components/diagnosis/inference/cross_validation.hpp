// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/diagnosis/inference/fitter.hpp"

namespace palpate::diagnosis {

/// How well a robot fitted to all other recordings predicts each: chi-squared of its rows under the
/// noise alone, and their residuals.
struct CrossValidation {
  std::vector<double> chi_squared;   ///< [recordings]
  std::vector<double> ln_predicted;  ///< [recordings] ln p(recording | the others)
  Eigen::VectorXd residual;          ///< [rows] whitened
};

/// Leaves out one recording at a time, never a frame: frames of one recording hang together.
CrossValidation LeaveOneOut(const HypothesisSet& hypotheses, const LinearModel& model,
                            const std::vector<int>& faults);

/// Whether a prediction is better than another: recordings that were left out are more probable
/// under it, and more than 10 % of the misfit beyond the noise is gone.
struct CrossValidationGain {
  double relative = 0.0;  ///< share of the misfit beyond the noise that is gone
  double ln_gain = 0.0;   ///< of what was predicted, all recordings
  bool clear = false;
};
CrossValidationGain Compare(const CrossValidation& before, const CrossValidation& after);

/// The same share of what was fitted: of the misfit of `before` beyond the noise that `after` has
/// not. Tolerances do not count: each fit has its own.
double FittedShare(const Fit& before, const Fit& after);

}  // namespace palpate::diagnosis
