// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>

#include "components/perception/observation.hpp"
#include "libs/rgbd/sensed_cloud.hpp"

namespace palpate::perception {

/// Where an object that is round next to its contact touches the robot behind what is seen of it.
struct HiddenContact {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
  double radius_m = 0.0;  ///< of the ball
  double gap_m = 0.0;  ///< from the object to the robot's surface around; < 0: it dents the robot
};

/// A ball is fitted to the object's points around `rim_m` (the mean of those next to the robot), a
/// plane to the robot's points around the ball, and the contact is the ball's point nearest to that
/// plane. Nothing where the object is not round there: an edge, a plate, the flank of a rod.
/// `noise_m`: sigma of a distance between the clouds.
std::optional<HiddenContact> FindHiddenContact(const rgbd::SensedCloud& robot,
                                               const rgbd::SensedCloud& object,
                                               const Eigen::Vector3d& rim_m, double noise_m);

/// The same for an object so large that nothing of the robot is seen near what is seen of it: all
/// its points [3 x n] make the ball, the contact is the ball's point nearest to `surface`. Nothing
/// where it is not round, or does not reach the surface to what both are known to.
std::optional<HiddenContact> FindContactUnder(const Eigen::Matrix3Xd& points_m,
                                              const PredictedSurface& surface, double noise_m);

}  // namespace palpate::perception
