// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/faults/view_motion.hpp"

#include <cmath>

namespace palpate::diagnosis {

Eigen::Isometry3d ViewMotion(const Eigen::VectorXd& z, const Eigen::Vector3d& middle_m) {
  const double angle_rad = z.tail<3>().norm();
  Eigen::Isometry3d move = Eigen::Isometry3d::Identity();
  if (angle_rad > 0.0) {
    move.linear() =
        Eigen::AngleAxisd(angle_rad, Eigen::Vector3d(z.tail<3>() / angle_rad)).toRotationMatrix();
  }
  move.translation() = middle_m - move.linear() * middle_m + z.head<3>();
  return move;
}

namespace {

/// The turn in space that a little more of one component of a turn's vector is.
Eigen::Vector3d TurnOf(const Eigen::Vector3d& turn_rad, int component) {
  const Eigen::Vector3d more = Eigen::Vector3d::Unit(component);
  const double angle_rad = turn_rad.norm();
  constexpr double kSmall_rad = 1e-4;
  if (angle_rad < kSmall_rad) return more + 0.5 * turn_rad.cross(more);
  const Eigen::Vector3d axis = turn_rad / angle_rad;
  return more + (1.0 - std::cos(angle_rad)) / angle_rad * axis.cross(more) +
         (1.0 - std::sin(angle_rad) / angle_rad) * axis.cross(axis.cross(more));
}

}  // namespace

void AddViewMotion(int parameter, const Eigen::VectorXd& z, const Eigen::Vector3d& middle_m,
                   const Eigen::Isometry3d& T_after, const FaultContext& at,
                   Eigen::Matrix3Xd* motion_m) {
  const Eigen::Isometry3d& T_given = at.T_measurement_robot();
  const Eigen::Isometry3d T_moved_measurement = (T_given * T_after).inverse();
  const Eigen::Matrix3Xd& counts_from_m = at.recording().counts_from_m;
  const bool are_displacements = at.target == Target::kMarkers && counts_from_m.size() > 0;
  if (are_displacements && parameter < 3) return;
  for (Eigen::Index m = 0; m < motion_m->cols(); ++m) {
    // What a depth camera with errors measured is not where it saw it.
    const Eigen::Vector3d measured_m = at.measured_points.camera
                                           ? at.measured_points.point(m).at_m
                                           : at.simulated().markers_m().col(m);
    Eigen::Vector3d lever_m = T_moved_measurement * measured_m - middle_m - z.head<3>();
    if (are_displacements)
      lever_m = T_moved_measurement.linear() * (measured_m - T_given * counts_from_m.col(m));
    const Eigen::Vector3d move = parameter < 3 ? Eigen::Vector3d(Eigen::Vector3d::Unit(parameter))
                                               : TurnOf(z.tail<3>(), parameter - 3).cross(lever_m);
    motion_m->col(m) += T_after.linear() * move;
  }
}

}  // namespace palpate::diagnosis
