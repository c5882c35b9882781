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
  double gap_m = 0.0;     ///< from the object to the robot's surface; < 0: it dents the robot
  bool touches = false;   ///< false: the gap is larger than what it is known to
};

/// To which distances between the clouds are known.
struct Resolution {
  double noise_m = 0.0;       ///< sigma of a distance along the view ray
  double resolution_m = 0.0;  ///< with the spacing of the points

  /// Of a place that lies anywhere within the resolution.
  double Variance_m2() const { return resolution_m * resolution_m / 12.0; }
};

/// A ball is fitted to the object's points around `rim_m` (the mean of those next to the robot).
/// The contact is the point of `surface` nearest to the ball's middle, seen or not, and the ball is
/// then taken to touch it, so that it is known better than from the cap that is seen of it; how
/// well stands in the covariance. Without a surface (nullptr) a plane fitted to the robot's points
/// around the ball stands for it. Nothing where the object is not round there: an edge, a plate,
/// the flank of a rod.
std::optional<HiddenContact> FindHiddenContact(const rgbd::SensedCloud& robot,
                                               const rgbd::SensedCloud& object,
                                               const Eigen::Vector3d& rim_m,
                                               const PredictedSurface* surface,
                                               const Resolution& known);

/// The same for an object so large that nothing of the robot is seen near what is seen of it: all
/// its points [3 x n] make the ball. Nothing where it is not round, or does not reach the surface
/// to what both are known to.
std::optional<HiddenContact> FindContactUnder(const Eigen::Matrix3Xd& points_m,
                                              const PredictedSurface& surface, double noise_m);

}  // namespace palpate::perception
