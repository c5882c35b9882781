// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/experiment/experiment.hpp"

namespace palpate::diagnosis {

/// The experiment with all stamps of actuation, markers, depth frames and loads on one clock. Where
/// a recording begins before the one before it ends, its clock began again: it is taken for made
/// after `rest_between_s`, or so long afterwards that the robot has forgotten.
experiment::Experiment OnOneTimebase(experiment::Experiment experiment);

}  // namespace palpate::diagnosis
