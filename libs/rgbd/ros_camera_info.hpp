// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/core/config_node.hpp"
#include "libs/rgbd/rgbd_camera.hpp"

namespace palpate::rgbd {

/// Whether the file is one of ROS' camera_calibration (image_width, camera_matrix, ...) or a
/// sensor_msgs/CameraInfo as `ros2 topic echo` prints it (width, k, d, ...).
bool IsRosCameraInfo(const ConfigNode& root);

/// The depth camera of such a file. It does not tell the unit of depth: `unit_m` must be added to
/// it; `invalid_value` and `baseline_m` may be. Rectification is not applied, so the distortion
/// must be that of the images. Throws InputError with file:line:column, also for a lens that is no
/// plumb_bob.
RgbdCamera ReadRosCameraInfo(const ConfigNode& root);

}  // namespace palpate::rgbd
