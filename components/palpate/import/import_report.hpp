// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>
#include <ostream>

#include "components/palpate/import/import_options.hpp"
#include "libs/experiment/captured_markers.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/experiment/recording.hpp"

namespace palpate::command {

/// Frames, rate and duration, and for each marker gaps, median residual and static noise. Returns
/// the static noise, the median of the markers' standard deviations along each axis of the
/// measurement frame, m, to two digits; nullopt where an axis shows none.
std::optional<Eigen::Vector3d> PrintQuality(const experiment::CapturedMarkers& captured,
                                            const experiment::Recording& recording,
                                            std::ostream& report);

/// The noise of a marker that a new experiment has.
void PrintNoise(const experiment::Experiment& settings, std::ostream& report);

/// In which frame the positions are, and what that means for their use.
void PrintFrame(const ImportOptions& options, const experiment::Recording& recording,
                std::ostream& report);

}  // namespace palpate::command
