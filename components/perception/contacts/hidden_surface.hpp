// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>

#include "components/perception/observation.hpp"
#include "libs/rgbd/sensed_cloud.hpp"

namespace palpate::perception {

/// Mean and covariance of the places where an object may touch.
struct HiddenSurface {
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
};

/// An object touches where the camera does not see the surface: of the surface around `rim_m` [3 x
/// n], the object's points next to the robot, the part that no point of the robot's cloud is nearer
/// to than `resolution_m`. It counts the less the farther it lies from the rim, over `reach_m`, as
/// far as the object's hidden part may reach. Nothing where all of the surface there is seen.
std::optional<HiddenSurface> FindHiddenSurface(const PredictedSurface& surface,
                                               const rgbd::SensedCloud& robot,
                                               const Eigen::Matrix3Xd& rim_m, double reach_m,
                                               double resolution_m);

}  // namespace palpate::perception
