// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>

#include "components/diagnosis/inference/fitter.hpp"

namespace palpate::diagnosis {

/// Whether what a fit leaves over is what noise and belief would leave.
struct GuardResult {
  bool passed = false;
  double surprise = 0.0;  ///< the worst test, in standard deviations of what a right model leaves
  std::string worst;      ///< "misfit of recording RH_hold", "runs in recording RB_repeat", ...
};

/// Misfit as a whole and in each recording, and how the residuals of neighbouring moments hang
/// together in each; compared with what `draws` experiments of the fitted model leave (parametric
/// bootstrap, seeded), the worst of all tests with the worst of each draw.
GuardResult Guard(const ObservedExperiment& observed, const CauseBook& book, const Fit& fit,
                  int draws = 200, std::uint64_t seed = 1);

}  // namespace palpate::diagnosis
