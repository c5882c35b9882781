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

/// Apparent motion of the fixed surface in one frame.
struct MotionSighting {
  int points = 0;  ///< on the fixed surface; with too few the frame has no information
  Motion motion = Motion::Zero();
  /// Inverse of its covariance by the points' noise alone, errors of neighbours taken as
  /// independent: too large, but the same from frame to frame.
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
};

struct HeldMotionTuning {
  /// Distance from the fixed surface. Larger: points of other objects; smaller: large motions are
  /// lost.
  double reach_m = 6e-3;
  /// Cosine of the line of sight to the surface's normal. Smaller: more points, at grazing angles,
  /// whose depth errs more.
  double least_cosine = 0.25;
  double surface_sigma_m = 3e-4;  ///< of the mesh along the normal; larger: near points count less
  double huber_sigmas = 2.0;      ///< smaller: more robust to outliers, less exact
  int rounds = 3;                 ///< of reweighting; more: slower, closer to the robust optimum
  int matchings = 3;              ///< each with a refinement; more: larger motions, slower
  int least_points = 30;          ///< of a frame; fewer: frames whose motion is uncertain
  std::size_t most_points = 500;  ///< more: slower, less noise
  double prior_turn_rad = 0.1;    ///< of directions that the points do not determine
  double prior_shift_m = 0.05;
  /// Change below which the points are not matched again: facets are much longer. Smaller: more
  /// matchings.
  double same_turn_rad = 4e-3;
  double same_shift_m = 5e-4;
};

/// Information of the motion's prior.
Eigen::Matrix<double, 6, 6> UnknownMotion(const HeldMotionTuning& tuning = {});

/// The motion that registers the model's surface (`x_m` [3n]; empty: at rest) to the cloud (camera
/// frame): point-to-plane, with errors of depth and mesh along the normal, robust (Huber).
MotionSighting SeeMotion(const FixedSurfaceRegion& region, const rgbd::SensedCloud& cloud,
                         const Eigen::Isometry3d& T_robot_camera, const Eigen::VectorXd& x_m,
                         const HeldMotionTuning& tuning = {});

}  // namespace palpate::force_estimation
