// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/diagnosis/data/timeline.hpp"
#include "libs/experiment/recording.hpp"

namespace palpate::diagnosis {

/// A stretch of a recording in which every command goes linearly and the loads stay.
struct Piece {
  double begin_s = 0.0;
  double end_s = 0.0;
  bool still = true;  ///< the commands stay, too
};

/// The pieces of a recording, in order. Knots of the commands are found by dropping those without
/// which the path stays within a hundredth of what the commands span (Ramer, Douglas, Peucker).
std::vector<Piece> PiecesOf(const experiment::Recording& recording, const Timeline& timeline,
                            double begin_s, double end_s);

/// Up to `most` windows of a piece: equally long in a motion, each twice as long as the one before
/// where nothing is moved.
std::vector<experiment::TimeWindow> WindowsOf(const Piece& piece, int most);

}  // namespace palpate::diagnosis
