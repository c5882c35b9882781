// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/diagnosis/diagnosis_result.hpp"
#include "components/diagnosis/inference/selection.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::diagnosis {

/// Fills what a result says of the gap between simulation and robot: in each recording and in all,
/// as built, within tolerances, with the causes that were named, and in recordings left out; and
/// the moments that figures are drawn from.
void DescribeGap(const ObservedExperiment& observed, const robot::RobotBody& body,
                 const CauseBook& book, const Fit& as_built, const Selection& selection,
                 DiagnosisResult* result);

/// Share of the as-built squares beyond the noise that the faults of a fit make go away, building
/// tolerances left as in the file: what the extended model gains.
double ExplainedShare(const ObservedExperiment& observed, const CauseBook& book,
                      const Fit& as_built, const Fit& best);

}  // namespace palpate::diagnosis
