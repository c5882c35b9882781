// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/diagnosis/data/observed_experiment.hpp"
#include "libs/core/status.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::diagnosis {

/// Estimates the measurement poses that are not given: rigid registration of the measured markers
/// with those of the nominal robot's simulation. Fails where the markers do not determine a pose.
Status RegisterUnknownPoses(const robot::RobotBody& body, int threads,
                            ObservedExperiment* observed);

}  // namespace palpate::diagnosis
