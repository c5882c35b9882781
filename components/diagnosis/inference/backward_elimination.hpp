// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/diagnosis/inference/selection.hpp"

namespace palpate::diagnosis {

/// Share of the null model's misfit beyond the noise that would come back without one of the named
/// causes, the others and the tolerances fitted again. The misfit counts residuals and tolerances,
/// each in its standard deviations: what tolerances take up far beyond their size is not explained.
double ExplainedShare(const HypothesisSet& hypotheses, const Selection& selection, int cause);

/// Once a further fault is named, those named before are tested again: one of them is exchanged for
/// any other of the hypothesis set where the evidence of all together is better so. Any is dropped
/// that the others leave no clear evidence for, or that explains next to nothing and does not
/// predict left-out recordings better (docs/theory/model_selection.md, Backward elimination).
/// Evidence and probability of those that are left are beside each other.
void EliminateBackward(const Fitter& fitter, double clear_evidence, Selection* selection);

}  // namespace palpate::diagnosis
