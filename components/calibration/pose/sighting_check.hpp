// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/calibration/pose/pose_and_inputs.hpp"
#include "libs/core/status.hpp"

namespace palpate::calibration {

/// Refuses unknown markers (of `marker_count`), duplicates, positions that are not finite and
/// covariances that are not positive definite (all kInvalidInput), and fewer than 3 sightings
/// (kUnobservable).
Status CheckSightings(const std::vector<MarkerSighting>& sightings, int marker_count);

/// The mirror image of the sightings, which equals markers assigned to mirror images.
std::vector<MarkerSighting> Mirrored(const std::vector<MarkerSighting>& sightings);

}  // namespace palpate::calibration
