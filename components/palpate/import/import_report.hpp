// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <ostream>

#include "components/palpate/import/import_options.hpp"
#include "libs/experiment/captured_markers.hpp"
#include "libs/experiment/recording.hpp"

namespace palpate::command {

/// Frames, rate and duration, and for each marker gaps, median residual and static noise.
void PrintQuality(const experiment::CapturedMarkers& captured,
                  const experiment::Recording& recording, std::ostream& report);

/// In which frame the positions are, and what that means for their use.
void PrintFrame(const ImportOptions& options, const experiment::Recording& recording,
                std::ostream& report);

}  // namespace palpate::command
