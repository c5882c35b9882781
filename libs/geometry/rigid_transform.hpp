// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace palpate::geometry {

/// A rigid motion. `T_a_b` maps coordinates in frame b to coordinates in frame a:
/// p_a = T_a_b * p_b, and T_a_c = T_a_b * T_b_c.
class RigidTransform {
 public:
  /// Identity.
  RigidTransform() = default;
  /// `rotation_a_b` must not be zero; it is normalised.
  RigidTransform(const Eigen::Quaterniond& rotation_a_b, const Eigen::Vector3d& translation_m);
  /// `rotation_a_b` must be a rotation matrix (orthonormal to 1e-6, determinant +1).
  RigidTransform(const Eigen::Matrix3d& rotation_a_b, const Eigen::Vector3d& translation_m);

  const Eigen::Quaterniond& rotation() const { return rotation_; }
  /// Origin of b, seen in a, m.
  const Eigen::Vector3d& translation_m() const { return translation_m_; }

  RigidTransform Inverse() const;
  RigidTransform operator*(const RigidTransform& T_b_c) const;
  Eigen::Vector3d operator*(const Eigen::Vector3d& point_b_m) const;
  /// [3 x n] points, one column each.
  Eigen::Matrix3Xd Apply(const Eigen::Ref<const Eigen::Matrix3Xd>& points_b_m) const;
  /// Turns a direction, force or displacement; no translation.
  Eigen::Vector3d Rotate(const Eigen::Vector3d& vector_b) const { return rotation_ * vector_b; }

 private:
  Eigen::Quaterniond rotation_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation_m_ = Eigen::Vector3d::Zero();
};

/// R = Rz Ry Rx: turns about the fixed x, then the fixed y, then the fixed z axis. Angles in
/// degrees, as robot files give them; multiples of 90 degrees are exact.
Eigen::Matrix3d RotationFromFixedXyz_deg(const Eigen::Vector3d& angles_deg);

}  // namespace palpate::geometry
