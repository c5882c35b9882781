// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <ostream>

#include "components/palpate/import/import_options.hpp"
#include "libs/experiment/recording.hpp"

namespace palpate::command {

/// Compares the markers at rest with the robot's, and with --register estimates
/// recording->T_robot_camera and its standard error first.
///
/// At rest: the mean over the rest window, or over the whole recording of kind rest; with
/// --register without a rest window over the whole recording, of markers that do not move. The
/// robot's: in the shape of the rest window, else undeformed. Reports that shape and the residual
/// of each marker. Throws InputError where options contradict each other, where the markers do not
/// determine the pose, and where they have another shape, or, of known pose, are turned or lie
/// elsewhere (force_estimation::CheckRestMarkers).
void PlaceMarkers(const ImportOptions& options, std::ostream& report,
                  experiment::Recording* recording);

}  // namespace palpate::command
