// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/diagnosis/inference/selection.hpp"
#include "components/diagnosis/vocabulary/diagnosis_result.hpp"

namespace palpate::diagnosis {

/// Fills verdict, reason and the result of the goodness-of-fit test.
void DescribeVerdict(const Selection& selection, DiagnosisResult* result);

/// Fills the named causes, with intervals averaged over places and further faults, and the
/// probability of an unmodelled cause. `robot`: the file that they change.
void DescribeCauses(const ObservedExperiment& observed, const Fitter& fitter,
                    const robot::RobotDescription& robot, const Selection& selection,
                    DiagnosisResult* result);

/// Fills what was not named: probabilities of the hypotheses for the first place, no fault among
/// them, and the canonical correlations. Needs DescribeCauses.
void DescribeRivals(const HypothesisSet& hypotheses, const Selection& selection,
                    DiagnosisResult* result);

}  // namespace palpate::diagnosis
