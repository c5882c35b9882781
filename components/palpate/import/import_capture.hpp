// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/palpate/import/import_options.hpp"
#include "libs/experiment/captured_markers.hpp"
#include "libs/experiment/recording.hpp"

namespace palpate::command {

/// Reads the file and does to the data all that the options ask for: other names, fewer markers,
/// other axes, a part of the time, fewer frames, and last the time offset. Throws InputError.
experiment::CapturedMarkers ReadAndEdit(const ImportOptions& options);

/// The recording that the options describe; its pose still has to be found where they ask for a
/// registration. Throws InputError, also for a window without a frame.
experiment::Recording MakeRecording(const ImportOptions& options,
                                    const experiment::CapturedMarkers& captured);

}  // namespace palpate::command
