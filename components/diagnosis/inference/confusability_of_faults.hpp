// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/diagnosis/inference/fitter.hpp"
#include "components/diagnosis/inference/hypothesis_set.hpp"

namespace palpate::diagnosis {

/// [fault models] Each is withheld in turn: share of its expected effect, beyond tolerances, that
/// `others` faults of other ids explain, chosen greedily, by the linear model; in [0, 1]. -1: the
/// data would not show such a fault.
std::vector<double> ExplainedByOthers(const HypothesisSet& hypotheses, const Information& data,
                                      std::size_t others);

/// Share F of the catalogue's ids that, withheld, `others` faults would explain to the share
/// `explained` or more. [0, 1]
double ShareOfConfusable(const HypothesisSet& hypotheses, const Information& data,
                         std::size_t others, double explained);

/// Share of the null model's misfit beyond the noise that a fit explains, [0, 1]. Two standard
/// deviations of chi-squared count as unexplained.
double ExplainedOfMisfit(const Fit& null_model, const Fit& fit);

/// Probability that an unmodelled cause takes the names of the named faults
/// (docs/theory/model_selection.md, Probabilities). Prior odds:
/// - 1, where the residual is not noise;
/// - 1/20 for one named fault and three times as much for each further one, where it is noise
///   (docs/diagnosis.md has the blind sets that these come from).
/// [0, 1)
double ProbabilityOfConfusion(const HypothesisSet& hypotheses, const Fit& null_model,
                              const Fit& fit, bool is_noise);

}  // namespace palpate::diagnosis
