// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/diagnosis/data/observed_experiment.hpp"
#include "libs/experiment/markers.hpp"

namespace palpate::diagnosis {

using MarkerFrames = std::vector<const experiment::MarkerFrame*>;

/// Means over `frames`: stamps, positions, and how many saw each marker. `columns` [markers]: into
/// MarkerFrame::positions_m; -1: the recording has no such marker.
///
/// In a motion the frames that saw a marker are not in the middle of all. So in a frame that did
/// not see it, it counts on the straight line between the frames of `of_motion` that saw it last
/// before and first after (all of the piece, rising; empty: nothing moves). Where there is no such
/// line, or most frames did not see it, it was not seen.
Sample AverageFrames(const MarkerFrames& frames, const MarkerFrames& of_motion,
                     const std::vector<int>& columns);

}  // namespace palpate::diagnosis
