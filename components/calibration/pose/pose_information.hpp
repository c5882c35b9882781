// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/calibration/pose/pose_and_inputs.hpp"
#include "libs/geometry/rigid_transform.hpp"

namespace palpate::calibration {

/// Whitens distances between measured and model markers in the robot frame.
class SightingWhitener {
 public:
  /// The covariances must be positive definite.
  explicit SightingWhitener(const std::vector<MarkerSighting>& sightings);

  /// L_k^-1 R' times each three rows, C_k = L_k L_k'. [3n x columns] in place.
  void Apply(const Eigen::Matrix3d& R_robot_camera, Eigen::Ref<Eigen::MatrixXd> rows) const;

 private:
  std::vector<Eigen::Matrix3d> inverse_factors_;
};

/// Inverse of the joint information of pose and inputs, [6 + a x 6 + a], of
///   e = L^-1 R' (R p + T - W_ea lambda - delta_e^free)
/// in (theta, tau, lambda_a). Unobservable directions have variances of at least 1e14 in units that
/// scale the information's diagonal to 1.
Eigen::MatrixXd JointCovariance(const std::vector<MarkerSighting>& sightings,
                                const SightingWhitener& whitener,
                                const geometry::RigidTransform& T_robot_camera,
                                const Eigen::MatrixXd& W_ea);

}  // namespace palpate::calibration
