// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "libs/core/index.hpp"

namespace palpate::calibration {

/// A measured marker.
struct MarkerSighting {
  int marker = -1;                                       ///< index into RobotBody::markers
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< camera frame
  /// Of measurement and model at the marker, camera frame; positive definite.
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
};

/// Largest distance between two measurements of one marker of a robot at rest.
inline constexpr double kStillMarker_m = 3e-3;

/// [3 x n]
inline Eigen::Matrix3Xd PositionsOf(const std::vector<MarkerSighting>& sightings) {
  Eigen::Matrix3Xd positions_m(3, ToIndex(sightings.size()));
  for (std::size_t k = 0; k < sightings.size(); ++k) {
    positions_m.col(ToIndex(k)) = sightings[k].position_m;
  }
  return positions_m;
}

}  // namespace palpate::calibration
