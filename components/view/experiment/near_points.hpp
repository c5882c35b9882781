// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>

#include "libs/rgbd/image.hpp"
#include "libs/rgbd/rgbd_camera.hpp"
#include "libs/rgbd/sensed_cloud.hpp"

namespace palpate::view {

/// Points of a depth image about a robot with its nodes at `nodes_m` [3 x n], in the robot frame:
/// within its bounding box and half of the box's diagonal about it. At most some 30 000, evenly
/// over the image; without colours and sigmas.
rgbd::SensedCloud NearPoints(const rgbd::DepthImage& depth, const rgbd::RgbdCamera& camera,
                             const Eigen::Isometry3d& T_robot_camera,
                             const Eigen::Matrix3Xd& nodes_m);

}  // namespace palpate::view
