// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "libs/robot/robot_body.hpp"

namespace palpate::diagnosis {

/// By how much more a finer mesh yields where a cable ends, under a force along the cable. Over
/// places within an element's size of the anchor, since another mesh has its nodes elsewhere.
struct AnchorError {
  double mean_m_N = 0.0;     ///< of these places
  double scatter_m_N = 0.0;  ///< their standard deviation; the mean where only one is on the body
};

/// [cables] of the body at rest. The elements about each anchor are held where they meet the
/// others, and cut into smaller ones until these are as small as the cable's guide, twice at most.
/// Curved edges of ten-node elements count as straight.
std::vector<AnchorError> FindAnchorErrors(const robot::RobotBody& body);

}  // namespace palpate::diagnosis
