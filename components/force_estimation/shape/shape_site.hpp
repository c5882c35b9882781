// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "components/force_estimation/shape/force_filter.hpp"
#include "components/force_estimation/shape/surface_map.hpp"
#include "libs/fem/surface_patch.hpp"

namespace palpate::force_estimation {

/// A contact that is tracked: a patch of the surface, its location with uncertainty, and the
/// significance of its force so far.
struct ShapeSite {
  std::string name;
  bool hidden = false;  ///< found by search: outside the camera's view
  MaterialPoint centre;
  fem::SurfacePatch patch;
  std::vector<int>
      triangles;  ///< of the drawn surface, around the centre: their mean gives the normal
  double radius_m = 0.0;
  /// Location in the camera image, mapped to the undeformed body, and its sigma in each direction
  /// along the surface. Of hidden ones the sigma is as large as the robot.
  Eigen::Vector3d seen_rest_m = Eigen::Vector3d::Zero();
  double seen_sigma_m = 0.0;
  /// Of a contact that was moved to the body's other side: from its visible location to there, m.
  Eigen::Vector3d turned_m = Eigen::Vector3d::Zero();

  /// Of hidden ones: mean and covariance of the location, its 95 % radius, and the part of the
  /// force's covariance that comes from it.
  Eigen::Vector3d place_mean_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d place_covariance_m2 = Eigen::Matrix3d::Zero();
  double place_ci95_m = 0.0;
  Eigen::Matrix3d place_force_covariance_N2 = Eigen::Matrix3d::Zero();

  ForceFilter filter;
  int frames = 0;                ///< in which it was tracked
  int significant_frames = 0;    ///< in a row, up to the last one; those beyond doubt count twice
  bool is_beyond_doubt = false;  ///< its force in the last frame
  int quiet_frames = 0;          ///< in a row without a significant force
  bool acts = false;             ///< its force is reported
};

}  // namespace palpate::force_estimation
