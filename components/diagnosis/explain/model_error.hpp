// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/diagnosis/inference/selection.hpp"
#include "components/diagnosis/vocabulary/diagnosis_result.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::diagnosis {

/// Fills what a result says of the model error between simulation and robot: in each recording and
/// in all, as built, within tolerances, with the causes that were named, and in recordings left
/// out; and the samples that figures are drawn from.
void DescribeModelError(const ObservedExperiment& observed, const robot::RobotBody& body,
                        const HypothesisSet& hypotheses, const Fit& as_built,
                        const Selection& selection, DiagnosisResult* result);

/// Share of the null model's misfit beyond the noise that would come back without one of the named
/// causes, the others and the tolerances fitted again. The misfit counts residuals and tolerances,
/// each in its standard deviations: what tolerances take up far beyond their size is not explained.
double ExplainedShare(const HypothesisSet& hypotheses, const Selection& selection, int cause);

}  // namespace palpate::diagnosis
