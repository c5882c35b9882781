// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <vector>

#include "components/calibration/marker_sighting.hpp"

namespace palpate::calibration {

/// The markers of one message; covariances are the noise of one message. A marker without a name
/// has the number -1.
struct SeenMarkers {
  std::int64_t stamp_ns = 0;
  std::vector<MarkerSighting> markers;  ///< camera frame
};

/// Whether any of them has a name.
bool HaveNames(const std::vector<MarkerSighting>& markers);

/// Mean of each marker over messages of a robot at rest. If any marker has a name, those without
/// are left out. If none has, each point of the message with most points is averaged with the
/// nearest one of every other, if that is within kStillMarker_m. In each direction the larger of
/// stated and observed variance counts. `bias_m`: standard deviation along each axis that averaging
/// does not reduce.
std::vector<MarkerSighting> MeanMarkers(const std::vector<SeenMarkers>& messages, double bias_m);

}  // namespace palpate::calibration
