// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "libs/experiment/experiment.hpp"

namespace palpate::offline {

/// The measurement that forces are estimated from.
enum class EstimateFrom { kMarkers, kShape };

std::string ToString(EstimateFrom from);

/// A recording to estimate, and its measurement.
struct PlannedRecording {
  const experiment::Recording* recording = nullptr;
  EstimateFrom from = EstimateFrom::kShape;
};

/// Whether the recording is contact-free by its kind: rest, ramp, hold, co_contraction,
/// second_speed, repeat, without known loads.
bool IsContactFree(const experiment::Recording& recording);

/// Whether the recording has depth images or clouds.
bool HasImages(const experiment::Recording& recording);

/// These recordings of the experiment, in this order; where none is given all that can be
/// estimated. From images where a recording has them, else from its markers; `from`, "markers" or
/// "shape", excludes the other ("": both). Throws InputError for a given one that lacks the
/// measurement, and where no recording is left.
std::vector<PlannedRecording> PlanEstimates(
    const experiment::Experiment& experiment,
    const std::vector<const experiment::Recording*>& recordings, const std::string& from);

/// The recordings from which the depth bias is estimated: contact-free ones with images, in their
/// order.
std::vector<const experiment::Recording*> BiasRecordings(const experiment::Experiment& experiment);

}  // namespace palpate::offline
