// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/camera_view.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>

namespace palpate::calibration {

namespace {

Eigen::Matrix3d Cross(const Eigen::Vector3d& v) {
  Eigen::Matrix3d cross;
  cross << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return cross;
}

Eigen::Quaterniond Exp(const Eigen::Vector3d& rotation_vector) {
  const double angle_rad = rotation_vector.norm();
  if (angle_rad == 0.0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, rotation_vector / angle_rad));
}

/// exp(v + dv) = exp(J dv) exp(v) to first order (the left Jacobian of SO(3)).
Eigen::Matrix3d LeftJacobian(const Eigen::Vector3d& v) {
  const double angle_rad = v.norm();
  const Eigen::Matrix3d cross = Cross(v);
  if (angle_rad < 1e-4) return Eigen::Matrix3d::Identity() + 0.5 * cross + cross * cross / 6.0;
  const double square = angle_rad * angle_rad;
  return Eigen::Matrix3d::Identity() + (1.0 - std::cos(angle_rad)) / square * cross +
         (angle_rad - std::sin(angle_rad)) / (square * angle_rad) * cross * cross;
}

}  // namespace

geometry::RigidTransform Changed(const geometry::RigidTransform& T, const PoseChange& change) {
  return {Exp(change.head<3>()) * T.rotation(), T.translation_m() + change.tail<3>()};
}

PoseChange ChangeBetween(const geometry::RigidTransform& from, const geometry::RigidTransform& to) {
  const Eigen::AngleAxisd turn(to.rotation() * from.rotation().conjugate());
  PoseChange change;
  change << turn.angle() * turn.axis(), to.translation_m() - from.translation_m();
  return change;
}

CameraView::CameraView(const geometry::RigidTransform& T_robot_camera_start,
                       const PoseChange& change)
    : T_(Changed(T_robot_camera_start, change)),
      R_(T_.rotation().toRotationMatrix()),
      turn_per_change_(LeftJacobian(change.head<3>())) {}

/// In the camera frame, in which the covariance is known: r = L^-1 (p - R' (x - t)).
SightingRows<3> CameraView::Rows(const MarkerSighting& sighting, const Eigen::Vector3d& point_m,
                                 double depth_scale) const {
  const Eigen::LLT<Eigen::Matrix3d> covariance(sighting.covariance_m2);
  const auto L = covariance.matrixL();
  const Eigen::Vector3d from_camera_m = point_m - T_.translation_m();
  SightingRows<3> rows;
  rows.residual =
      L.solve((1.0 + depth_scale) * sighting.position_m - R_.transpose() * from_camera_m);
  rows.per_point_m = -L.solve(Eigen::Matrix3d(R_.transpose()));
  rows.per_pose.leftCols<3>() = rows.per_point_m * Cross(from_camera_m) * turn_per_change_;
  rows.per_pose.rightCols<3>() = -rows.per_point_m;
  rows.per_depth_scale = L.solve(sighting.position_m);
  return rows;
}

SightingRows<1> CameraView::Rows(const SurfaceSighting& sighting, const Eigen::Vector3d& point_m,
                                 double depth_scale) const {
  const Eigen::Vector3d turned_m = R_ * sighting.position_m;
  const Eigen::Vector3d scaled_m = (1.0 + depth_scale) * turned_m;
  const Eigen::RowVector3d along = sighting.normal.transpose() / sighting.sigma_m;
  SightingRows<1> rows;
  rows.residual << along.dot(scaled_m + T_.translation_m() - point_m);
  rows.per_point_m = -along;
  rows.per_pose.leftCols<3>() = -along * Cross(scaled_m) * turn_per_change_;
  rows.per_pose.rightCols<3>() = along;
  rows.per_depth_scale << along.dot(turned_m);
  return rows;
}

}  // namespace palpate::calibration
