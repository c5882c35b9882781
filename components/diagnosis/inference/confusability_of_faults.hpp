// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/diagnosis/inference/fitter.hpp"
#include "components/diagnosis/inference/hypothesis_set.hpp"

namespace palpate::diagnosis {

/// [faults] Recoveries with each fault of the catalogue withheld in turn: how much of what it does,
/// beyond what the tolerances would do, so many others would explain, each the one that does most
/// beside those before it, of those with another id; in [0, 1]. Expected over how large a fault may
/// be, by the linear model. -1: the data would not show such a fault.
std::vector<double> ExplainedByOthers(const HypothesisSet& hypotheses, const Information& data,
                                      std::size_t others);

/// Which share of the catalogue's ids, withheld, so many others would explain to `explained` at
/// least, as much as what is named explains of a model error. [0, 1]
double ShareOfConfusable(const HypothesisSet& hypotheses, const Information& data,
                         std::size_t others, double explained);

/// How much of what is beyond tolerances and noise a fit explains, of what `nominal` leaves, in
/// squares of noise; [0, 1]. What the noise's own scatter may hide counts as left.
double ExplainedOfMisfit(const Fit& null_model, const Fit& fit);

/// How likely it is that what is named stands in the place of a fault that the catalogue does not
/// hold. In its place only if what is named explains so much of it, as is more or less usual among
/// faults; before,
/// - where the residual is not noise, something is there that has no name: it is as likely to be
///   beside what is named as in its place;
/// - where it looks like noise, a twentieth as likely as one fault of the catalogue, and each
///   further fault is a third as likely as that there is none (docs/diagnosis.md says from where).
/// [0, 1)
double ProbabilityOfConfusion(const HypothesisSet& hypotheses, const Fit& null_model,
                              const Fit& fit, bool is_noise);

}  // namespace palpate::diagnosis
