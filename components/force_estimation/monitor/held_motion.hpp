// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "components/force_estimation/monitor/fixed_surface_region.hpp"
#include "libs/rgbd/sensed_cloud.hpp"

namespace palpate::force_estimation {

/// A small rigid motion: turn (rad), then shift of FixedSurfaceRegion::Middle_m (m), robot frame.
using Motion = Eigen::Matrix<double, 6, 1>;

/// What one frame says of how the held skin seems to have moved.
struct MotionSighting {
  int points = 0;  ///< on the held skin; with fewer than 30 the frame says nothing
  Motion motion = Motion::Zero();
  /// Inverse of its covariance by the points' noise alone, errors of neighbours taken as
  /// independent: too large, but the same from frame to frame.
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
};

/// What a frame that tells nothing of a direction says of it, as information: 0.1 rad, 50 mm.
Eigen::Matrix<double, 6, 6> UnknownMotion();

/// The motion that carries the skin, as the model has it (`x_m` [3n]; empty: at rest), onto the
/// cloud (camera frame): point-to-plane, errors of a point along the normal being those of its
/// depth and 0.3 mm of the skin, robust (Huber), on at most 500 points.
MotionSighting SeeMotion(const FixedSurfaceRegion& skin, const rgbd::SensedCloud& cloud,
                         const Eigen::Isometry3d& T_robot_camera, const Eigen::VectorXd& x_m);

}  // namespace palpate::force_estimation
