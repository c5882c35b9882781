// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/shape_frame.hpp"

namespace palpate::force_estimation {

SeenContact InRobotFrame(const SeenContact& in_camera, const Eigen::Isometry3d& T_robot_camera) {
  const Eigen::Matrix3d R_robot_camera = T_robot_camera.linear();
  SeenContact contact = in_camera;
  contact.position_m = T_robot_camera * in_camera.position_m;
  contact.covariance_m2 = R_robot_camera * in_camera.covariance_m2 * R_robot_camera.transpose();
  return contact;
}

Eigen::Index ShapeFrame::PointCount() const {
  Eigen::Index count = 0;
  for (const ShapeView& view : views) count += view.cloud.Count();
  return count;
}

CameraPoses ShapeFrame::Poses() const {
  CameraPoses poses;
  for (const ShapeView& view : views) poses.push_back(view.T_robot_camera);
  return poses;
}

}  // namespace palpate::force_estimation
