// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <vector>

#include "components/calibration/marker_sighting.hpp"

namespace palpate::calibration {

/// The markers in one picture; covariances are of one picture's noise. A marker of which nobody
/// says which it is has the number -1.
struct SeenMarkers {
  std::int64_t stamp_ns = 0;
  std::vector<MarkerSighting> markers;  ///< camera frame
};

/// Whether any of them is said to be one of the robot's.
bool HaveNames(const std::vector<MarkerSighting>& markers);

/// Of each marker the mean over the pictures of a robot at rest that show it. Where any has a name
/// those without are left out; where none has, each point of the fullest picture is averaged with
/// the nearest one of every other that is no farther than kStillMarker_m. What they vary by counts
/// as the noise of one picture where that is more than the pictures say, in whatever direction.
/// `bias_m`: what averaging does not remove, one sigma along each axis.
std::vector<MarkerSighting> MeanMarkers(const std::vector<SeenMarkers>& pictures, double bias_m);

}  // namespace palpate::calibration
