// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "components/perception/observation.hpp"

namespace palpate::perception {

/// The surface that the model predicts, in the camera frame. `nodes_m` [3 x n]: nodes in
/// the robot frame, in single precision as /robot/mesh_state carries them, so that every process
/// that computes without that message gets the same bits. `triangles` [3 x t]: node numbers,
/// anticlockwise from outside.
PredictedSurface MakePredictedSurface(const Eigen::Ref<const Eigen::Matrix3Xf>& nodes_m,
                                      const Eigen::Ref<const Eigen::Matrix3Xi>& triangles,
                                      const Eigen::Isometry3d& T_robot_camera);

}  // namespace palpate::perception
