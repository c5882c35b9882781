// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/diagnosis/inference/selection.hpp"

namespace palpate::diagnosis {

/// Once a further cause is named, those named before are put to the question: one of them is
/// exchanged for a rival of its where the evidence of all together is better so, and any that the
/// others leave no clear evidence for is dropped (DIAGNOSIS, "Method" 6). `rivals` [named] of each
/// when it was named.
void CheckBackward(const Fitter& fitter, double clear_evidence,
                   std::vector<std::vector<int>>* rivals, Selection* selection);

}  // namespace palpate::diagnosis
