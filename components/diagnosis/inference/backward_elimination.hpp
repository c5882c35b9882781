// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/diagnosis/inference/selection.hpp"

namespace palpate::diagnosis {

/// Once a further cause is named, those named before are put to the question: one of them is
/// exchanged for any other of the book where the evidence of all together is better so, and any
/// that the others leave no clear evidence for is dropped (DIAGNOSIS, "Method" 6). Evidence and
/// probability of those that are left are beside each other.
void EliminateBackward(const Fitter& fitter, double clear_evidence, Selection* selection);

}  // namespace palpate::diagnosis
