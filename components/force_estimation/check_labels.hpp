// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/experiment/experiment.hpp"
#include "libs/robot/robot_description.hpp"

namespace palpate::force_estimation {

/// Compares the markers of each recording at rest (kind rest, or its reference window) with the
/// robot file's. Throws InputError with the recording and the labels that look exchanged, before
/// any physics is blamed for them.
void CheckMarkerLabels(const experiment::Experiment& experiment,
                       const robot::RobotDescription& robot);

}  // namespace palpate::force_estimation
