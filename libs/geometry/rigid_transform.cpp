// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/geometry/rigid_transform.hpp"

#include <cmath>
#include <numbers>

#include "libs/core/check.hpp"

namespace palpate::geometry {

namespace {

/// Sine of an angle in degrees, exact at multiples of 90.
double Sine_deg(double angle_deg) {
  const double turn_deg = std::remainder(angle_deg, 360.0);
  if (turn_deg == 0.0 || std::abs(turn_deg) == 180.0) return 0.0;
  if (std::abs(turn_deg) == 90.0) return std::copysign(1.0, turn_deg);
  return std::sin(turn_deg * std::numbers::pi / 180.0);
}

double Cosine_deg(double angle_deg) { return Sine_deg(angle_deg + 90.0); }

}  // namespace

RigidTransform::RigidTransform(const Eigen::Quaterniond& rotation_a_b,
                               const Eigen::Vector3d& translation_m)
    : rotation_(rotation_a_b), translation_m_(translation_m) {
  PALPATE_CHECK(rotation_a_b.norm() > 1e-9, rotation_a_b.norm());
  rotation_.normalize();
}

RigidTransform::RigidTransform(const Eigen::Matrix3d& rotation_a_b,
                               const Eigen::Vector3d& translation_m)
    : RigidTransform(Eigen::Quaterniond(rotation_a_b), translation_m) {
  PALPATE_CHECK((rotation_a_b.transpose() * rotation_a_b).isIdentity(1e-6), rotation_a_b);
  PALPATE_CHECK(rotation_a_b.determinant() > 0.0, rotation_a_b);
}

RigidTransform RigidTransform::Inverse() const {
  const Eigen::Quaterniond rotation_b_a = rotation_.conjugate();
  return {rotation_b_a, -(rotation_b_a * translation_m_)};
}

RigidTransform RigidTransform::operator*(const RigidTransform& T_b_c) const {
  return {rotation_ * T_b_c.rotation_, *this * T_b_c.translation_m_};
}

Eigen::Vector3d RigidTransform::operator*(const Eigen::Vector3d& point_b_m) const {
  return rotation_ * point_b_m + translation_m_;
}

Eigen::Matrix3Xd RigidTransform::Apply(const Eigen::Ref<const Eigen::Matrix3Xd>& points_b_m) const {
  return (rotation_.toRotationMatrix() * points_b_m).colwise() + translation_m_;
}

Eigen::Matrix3d RotationFromFixedXyz_deg(const Eigen::Vector3d& angles_deg) {
  const Eigen::Array3d s = angles_deg.unaryExpr(&Sine_deg).array();
  const Eigen::Array3d c = angles_deg.unaryExpr(&Cosine_deg).array();
  Eigen::Matrix3d R_x, R_y, R_z;
  R_x << 1, 0, 0, 0, c.x(), -s.x(), 0, s.x(), c.x();
  R_y << c.y(), 0, s.y(), 0, 1, 0, -s.y(), 0, c.y();
  R_z << c.z(), -s.z(), 0, s.z(), c.z(), 0, 0, 0, 1;
  return R_z * R_y * R_x;
}

}  // namespace palpate::geometry
