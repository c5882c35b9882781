// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/virtual_camera/drawing.hpp"

namespace palpate::virtual_camera {

/// A right hand, half closed, of capsules: palm, thumb, four fingers, wrist. In the tool's frame
/// the palm's centre is the origin, the fingers point along x, the back of the hand faces z.
std::vector<DrawnRound> MakeHand(const Eigen::Isometry3d& T_robot_tool, int paint);

}  // namespace palpate::virtual_camera
