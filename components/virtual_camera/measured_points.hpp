// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "components/virtual_camera/camera_faults.hpp"
#include "libs/rgbd/camera_model.hpp"

namespace palpate::virtual_camera {

/// Where the depth camera, with its faults and without noise, measures points of surfaces: at the
/// pixel that its true lens shows each at, on that pixel's ray as the data sheet has it. Nothing
/// hides a point. `points_m` [3 x n] and `normals` [3 x n] (unit, outward) in the true camera's
/// frame, `t_s` since it was switched on. NaN: behind the camera, or outside of its image.
Eigen::Matrix3Xd MeasurePoints(const CameraFaults& faults, const rgbd::CameraModel& data_sheet,
                               double t_s, const Eigen::Matrix3Xd& points_m,
                               const Eigen::Matrix3Xd& normals);

}  // namespace palpate::virtual_camera
