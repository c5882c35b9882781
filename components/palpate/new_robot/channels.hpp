// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/palpate/new_robot/body_shape.hpp"

namespace palpate::command {

/// A straight round hole, long and thin, that opens at the surface.
struct Channel {
  Eigen::Vector3d start_m = Eigen::Vector3d::Zero();  ///< ends of its axis
  Eigen::Vector3d end_m = Eigen::Vector3d::Zero();
  double radius_m = 0.0;   ///< mean distance of the wall from the axis
  std::vector<int> faces;  ///< of the boundary, rising
};

/// The channels of a body in which cables can run: straight, round, at least six times as long as
/// wide, and narrower than a tenth of the body. Only what is surely one is found.
std::vector<Channel> FindChannels(const BodyShape& shape);

}  // namespace palpate::command
