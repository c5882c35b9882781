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

/// A contact that is being followed: a patch of the skin, what is known of its place, and whether
/// its force has shown.
struct ShapeSite {
  std::string name;
  bool hidden = false;  ///< found by search: nobody sees it
  SkinPoint centre;
  fem::SurfacePatch patch;
  std::vector<int> triangles;  ///< of the drawn surface, around the centre: which way it faces
  double radius_m = 0.0;
  /// Where it was seen, on the undeformed body, and how surely (one sigma in each direction along
  /// the surface). Of hidden ones the sigma is as large as the robot.
  Eigen::Vector3d seen_rest_m = Eigen::Vector3d::Zero();
  double seen_sigma_m = 0.0;
  /// What is seen there pushes from the body's other side: so far from where it is seen, m.
  Eigen::Vector3d turned_m = Eigen::Vector3d::Zero();

  /// Of hidden ones: the place's covariance and the radius that holds it with 95 %, and what not
  /// knowing it does to the force.
  Eigen::Matrix3d place_covariance_m2 = Eigen::Matrix3d::Zero();
  double place_ci95_m = 0.0;
  Eigen::Matrix3d place_force_covariance_N2 = Eigen::Matrix3d::Zero();

  ForceFilter filter;
  int frames = 0;              ///< in which it was followed
  int significant_frames = 0;  ///< in a row, up to the last one; those beyond doubt count twice
  int quiet_frames = 0;        ///< in a row without a significant force
  bool acts = false;           ///< its force is reported
};

}  // namespace palpate::force_estimation
