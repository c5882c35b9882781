// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>

#include "components/perception/contacts/surface_around.hpp"
#include "components/perception/observation.hpp"
#include "libs/rgbd/sensed_cloud.hpp"

namespace palpate::perception {

/// Mean and covariance of the places where an object may touch.
struct HiddenSurface {
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
};

struct HiddenSurfaceTuning {
  SurfaceAroundTuning around = {};
  /// Distance from the rim, in reach_m, up to which the surface counts. Larger: slower; the weight
  /// beyond is below 5 %.
  double most_reaches = 2.5;
};

/// An object touches where the surface is occluded: of the surface around `rim_m` [3 x n], the
/// object's points next to the robot, the part without a point of the robot's cloud within
/// `resolution_m`. Its weight falls with the distance from the rim, over `reach_m`, the extent of
/// the object's hidden part. Empty where all of the surface there is visible.
std::optional<HiddenSurface> FindHiddenSurface(const PredictedSurface& surface,
                                               const rgbd::SensedCloud& robot,
                                               const Eigen::Matrix3Xd& rim_m, double reach_m,
                                               double resolution_m,
                                               const HiddenSurfaceTuning& tuning = {});

}  // namespace palpate::perception
