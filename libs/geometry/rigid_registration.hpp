// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/core/status.hpp"
#include "libs/geometry/rigid_transform.hpp"

namespace palpate::geometry {

/// Where a registration fails, the transform is none: identity, not to be used.
struct Registration {
  /// kUnobservable: fewer than 3 points, all in one place or on one line, or so near to it that
  /// their errors leave the turn open by more than 0.3 rad. kInvalidInput: unequal numbers, a value
  /// that is not finite, a covariance that is none, or mirrored points (`mirrored`).
  Status status;
  RigidTransform T_target_source;
  double rms_m = 0.0;  ///< root mean square distance of the pairs after the motion
  /// The same after the best motion with a reflection. Points in a plane do not distinguish one
  /// from the other.
  double mirrored_rms_m = 0.0;
  /// The reflection explains the points far better: they are assigned the wrong way round.
  bool mirrored = false;
  double chi_squared = 0.0;    ///< of the distances, over their covariance; given covariances only
  int degrees_of_freedom = 0;  ///< 3n - 6
  /// Of (theta, tau) in Exp(theta) R and T + tau: rotation vector along the target's axes, rad, and
  /// the source's origin as seen in the target frame, m. [6 x 6]
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

/// The rigid motion that takes `source_m` to `target_m` (column k to column k, [3 x n] both) with
/// the least sum of squared distances, never a reflection: eq. (7) of the paper for given inputs.
/// Arun, Huang, Blostein (1987), with the sign rule of Umeyama (1991), eqs. (40)-(43). The errors
/// of the points are taken as equal in all directions, their size from the distances left.
Registration RegisterRigid(const Eigen::Ref<const Eigen::Matrix3Xd>& source_m,
                           const Eigen::Ref<const Eigen::Matrix3Xd>& target_m);

/// The same with known errors of the source's points: the least sum of squared Mahalanobis
/// distances, from the solution with weights 1 / trace on by Gauss-Newton.
/// `source_covariance_m2` [n], in the source frame, positive definite. The covariance of the result
/// is what they say, not widened by what is left.
Registration RegisterRigid(const Eigen::Ref<const Eigen::Matrix3Xd>& source_m,
                           const Eigen::Ref<const Eigen::Matrix3Xd>& target_m,
                           const std::vector<Eigen::Matrix3d>& source_covariance_m2);

/// The same with one standard deviation per point, > 0, equal in all directions. [n]
Registration RegisterRigid(const Eigen::Ref<const Eigen::Matrix3Xd>& source_m,
                           const Eigen::Ref<const Eigen::Matrix3Xd>& target_m,
                           const Eigen::Ref<const Eigen::VectorXd>& source_sigma_m);

/// V with V w = v x w.
Eigen::Matrix3d CrossMatrix(const Eigen::Vector3d& v);

/// The motion turned by Exp(theta) about its own origin and shifted by tau, both in target axes:
/// what Registration::covariance is about.
RigidTransform Perturbed(const RigidTransform& T_target_source, const Eigen::Vector3d& theta_rad,
                         const Eigen::Vector3d& tau_m);

}  // namespace palpate::geometry
