// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "libs/rgbd/sensed_cloud.hpp"
#include "libs/rgbd/texture_points.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// A contact that perception has located (Algorithm 2), robot frame.
struct SeenContact {
  std::string name;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
  Eigen::Vector3d extent_m = Eigen::Vector3d::Zero();  ///< full size along the camera's axes
  int point_count = 0;
};

/// A contact given in the camera's frame, in the robot's; its extent stays along the camera's axes.
SeenContact InRobotFrame(const SeenContact& in_camera, const Eigen::Isometry3d& T_robot_camera);

/// What one camera sees of the robot in a frame.
struct ShapeView {
  rgbd::SensedCloud cloud;  ///< the robot's points, camera frame; empty: the camera sees none, or
                            ///< has no image of this time
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
  rgbd::TexturePoints texture = {};  ///< that the camera follows, camera frame
};

/// T_robot_camera of each camera.
using CameraPoses = std::vector<Eigen::Isometry3d>;

/// Input of one frame.
struct ShapeFrame {
  double t_s = 0.0;
  /// One for each camera, in an order that is the same in all frames.
  std::vector<ShapeView> views = {{}};
  std::vector<SeenContact> contacts;
  std::vector<robot::ActuatorCommand> cables;  ///< in the order of the robot's cables
  /// Of the cameras, or the number of the recording. A change begins a sequence, whose contacts are
  /// unknown.
  std::uint32_t epoch = 0;
  /// The frame is known to be contact-free: it serves to estimate depth bias and noise only.
  bool untouched = false;

  Eigen::Index PointCount() const;  ///< of all clouds
  CameraPoses Poses() const;
};

}  // namespace palpate::force_estimation
