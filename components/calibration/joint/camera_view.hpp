// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "components/calibration/joint/calibration_frame.hpp"
#include "libs/geometry/rigid_transform.hpp"

namespace palpate::calibration {

/// Change of a pose: rotation vector (rad, axes of the target frame) and translation (m).
using PoseChange = Eigen::Matrix<double, 6, 1>;

/// T with R = exp(change[0..2]) R_0 and t = t_0 + change[3..5].
geometry::RigidTransform Changed(const geometry::RigidTransform& T, const PoseChange& change);
/// The change that Changed(from, change) = to.
PoseChange ChangeBetween(const geometry::RigidTransform& from, const geometry::RigidTransform& to);

/// Residual rows of one sighting, measured minus predicted, whitened, and their derivatives.
template <int Rows>
struct SightingRows {
  Eigen::Matrix<double, Rows, 1> residual;
  Eigen::Matrix<double, Rows, 6> per_pose;         ///< per unit of PoseChange
  Eigen::Matrix<double, Rows, 1> per_depth_scale;  ///< per share of the distance
  Eigen::Matrix<double, Rows, 3> per_point_m;      ///< per motion of the body's point, robot frame
};

/// Measurement model of the camera at a pose that is being estimated.
class CameraView {
 public:
  CameraView(const geometry::RigidTransform& T_robot_camera_start, const PoseChange& change);

  const geometry::RigidTransform& T_robot_camera() const { return T_; }

  /// `point_m`: the model's marker, robot frame. A point measured at p is at (1 + depth_scale) p.
  SightingRows<3> Rows(const MarkerSighting& sighting, const Eigen::Vector3d& point_m,
                       double depth_scale) const;
  /// Distance to the surface along its normal.
  SightingRows<1> Rows(const SurfaceSighting& sighting, const Eigen::Vector3d& point_m,
                       double depth_scale) const;

 private:
  geometry::RigidTransform T_;
  Eigen::Matrix3d R_;
  Eigen::Matrix3d turn_per_change_;  ///< rotation of the robot frame's axes per rotation vector
};

}  // namespace palpate::calibration
