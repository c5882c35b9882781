// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "libs/experiment/experiment.hpp"

namespace palpate::command {

/// What forces are estimated from.
enum class EstimateFrom { kMarkers, kShape };

std::string ToString(EstimateFrom from);

/// A recording to estimate, and how.
struct PlannedRecording {
  const experiment::Recording* recording = nullptr;
  EstimateFrom from = EstimateFrom::kShape;
};

/// Whether nobody touched the robot, by the recording's kind: rest, ramp, hold, co_contraction,
/// second_speed, repeat.
bool IsUntouched(const experiment::Recording& recording);

/// Whether it has depth images or clouds.
bool HasImages(const experiment::Recording& recording);

/// The recordings of these names, in this order; without names all that can be estimated. From
/// images where a recording has them, else from its markers; `from`, "markers" or "shape", leaves
/// the other way out ("" : both). Throws InputError for a recording that is not there, one that is
/// named but cannot be estimated so, and where nothing is left.
std::vector<PlannedRecording> PlanEstimates(const experiment::Experiment& experiment,
                                            const std::vector<std::string>& names,
                                            const std::string& from);

/// Those that teach: untouched recordings with images, in their order.
std::vector<const experiment::Recording*> Teachers(const experiment::Experiment& experiment);

}  // namespace palpate::command
