// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/diagnosis/inference/selection.hpp"

namespace palpate::diagnosis {

/// Once a further fault is named, those named before are tested again: one of them is exchanged for
/// any other of the hypothesis set where the evidence of all together is better so, and any that
/// the others leave no clear evidence for is dropped (docs/theory/model_selection.md, Backward
/// elimination). Evidence and probability of those that are left are beside each other. An exchange
/// that was simulated and left about the same evidence is not identifiable from what is named.
void EliminateBackward(const Fitter& fitter, double clear_evidence, Selection* selection);

}  // namespace palpate::diagnosis
