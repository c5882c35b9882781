// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>

#include "components/diagnosis/diagnose.hpp"
#include "components/diagnosis/vocabulary/diagnosis_result.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/robot/robot_description.hpp"

namespace palpate::command {

/// Error of the known loads of an experiment (EstimateKnownLoads): with the robot file, and with
/// the extended files of `diagnosis`. The same frames count in both. Without forces where no
/// recording has known loads that are measured, or the files hold no cause. Both are estimated at
/// once where there are two `threads`. Ends early where `stop_requested`, which both ask; data that
/// cannot be estimated from are said in `why_not`.
diagnosis::ForceError MeasureForceError(const robot::RobotDescription& robot,
                                        const diagnosis::Diagnosis& diagnosis,
                                        const experiment::Experiment& experiment, int threads,
                                        const std::function<bool()>& stop_requested);

}  // namespace palpate::command
