// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/diagnosis/inference/fitter.hpp"

namespace palpate::diagnosis {

/// How well a robot fitted to all other recordings predicts each: chi-squared of its rows under the
/// noise alone, and their residuals.
struct HeldOut {
  std::vector<double> chi_squared;   ///< [recordings]
  std::vector<double> ln_predicted;  ///< [recordings] ln p(recording | the others)
  Eigen::VectorXd residual;          ///< [rows] whitened
};

/// Leaves out one recording at a time, never a frame: frames of one recording hang together.
HeldOut LeaveOneOut(const CauseBook& book, const Fit& fit);

/// Whether a prediction is better than another beyond chance: by more than 3 % of the other's
/// misfit beyond the noise and by two standard errors over recordings.
struct HeldOutGain {
  double relative = 0.0;        ///< share of the misfit that is gone, whole rows counted
  double ln_gain = 0.0;         ///< of what was predicted, all recordings
  double standard_error = 0.0;  ///< of ln_gain
  int recordings = 0;           ///< that are predicted clearly better
  bool clear = false;
};
HeldOutGain Compare(const HeldOut& before, const HeldOut& after);

}  // namespace palpate::diagnosis
