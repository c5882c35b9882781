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

/// Share of the squares beyond the noise, as a robot within its tolerances leaves them in
/// recordings that have any, that would come back without one of the named causes, the others and
/// the tolerances fitted again: in what was fitted, or in recordings left out, where it is more. In
/// what they are fitted to tolerances take up most of what a small cause does; a cause that one
/// recording alone shows appears there.
double ExplainedShare(const ObservedExperiment& observed, const HypothesisSet& hypotheses,
                      const Selection& selection, int cause);

}  // namespace palpate::diagnosis
