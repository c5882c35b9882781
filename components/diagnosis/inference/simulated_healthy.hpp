// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>

#include "components/diagnosis/inference/fitter.hpp"
#include "components/diagnosis/inference/linear_comparison.hpp"
#include "components/diagnosis/vocabulary/diagnosis_result.hpp"

namespace palpate::diagnosis {

/// Draws `draws` robots of the null model, measured as this experiment was, and compares each with
/// every fault. Tolerances, discrepancy and noise are as the null model has them. A fault would be
/// named at `clear_evidence` and `least_tolerances` of its tolerances.
SimulatedHealthy SimulateHealthyRobots(const HypothesisSet& hypotheses,
                                       const LinearComparison& comparison, const Fit& null_model,
                                       double clear_evidence, double least_tolerances,
                                       int draws = 200, std::uint64_t seed = 1);

}  // namespace palpate::diagnosis
