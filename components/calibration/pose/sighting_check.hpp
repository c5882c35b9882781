// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/calibration/pose/pose_and_inputs.hpp"
#include "libs/core/status.hpp"

namespace palpate::calibration {

/// Refuses a marker that the robot (with `marker_count`) has not or that is sighted twice, a
/// position that is not finite, a covariance that is not positive definite (all kInvalidInput), and
/// fewer than 3 sightings (kUnobservable).
Status CheckSightings(const std::vector<MarkerSighting>& sightings, int marker_count);

/// The sightings as a mirror shows them: what markers look like that are assigned the wrong way
/// round.
std::vector<MarkerSighting> Mirrored(const std::vector<MarkerSighting>& sightings);

}  // namespace palpate::calibration
