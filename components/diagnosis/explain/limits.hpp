// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/diagnosis/inference/selection.hpp"
#include "components/diagnosis/vocabulary/diagnosis_result.hpp"

namespace palpate::diagnosis {

/// Fills what these data can show, by the linear model of the null model: the smallest size of each
/// fault that would be named, how often a healthy robot would be accused, and how far the model is
/// off that no parameter says.
void DescribeLimits(const HypothesisSet& hypotheses, const Selection& selection,
                    DiagnosisResult* result);

}  // namespace palpate::diagnosis
