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

}  // namespace palpate::diagnosis
