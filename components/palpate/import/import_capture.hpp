// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/palpate/import/import_options.hpp"
#include "libs/experiment/captured_markers.hpp"
#include "libs/experiment/recording.hpp"

namespace palpate::command {

/// Reads the file and applies the options in this order: names, selection of markers, axes, time
/// window, frame rate, time offset. Throws InputError.
experiment::CapturedMarkers ReadAndEdit(const ImportOptions& options);

/// The recording that the options describe; without its pose where --register is to estimate it.
/// Throws InputError, also for a window without a frame.
experiment::Recording MakeRecording(const ImportOptions& options,
                                    const experiment::CapturedMarkers& captured);

}  // namespace palpate::command
