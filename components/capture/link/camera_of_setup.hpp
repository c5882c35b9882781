// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "components/capture/genicam/device_setup.hpp"
#include "libs/rgbd/rgbd_camera.hpp"

namespace palpate::capture {

/// What the user knows better about the colour camera. Unset: the camera's own.
struct ColorOverrides {
  std::optional<double> fx_px, fy_px, cx_px, cy_px;
  std::vector<double> distortion;  ///< k1, k2, p1, p2, k3[, k4, k5, k6]; empty: none
  std::optional<bool> registered;
  std::optional<Eigen::Isometry3d> T_depth_color;
};

/// The camera of a device that sends depth, with the colour that comes along.
rgbd::RgbdCamera CameraOfSetup(const DeviceSetup& setup, double depth_unit_m,
                               const ColorOverrides& overrides);

/// Puts the colour of `setup`, perhaps of another device than the depth's, into `camera`.
/// Images of one device and one size count as registered unless reported otherwise.
void AddColor(const DeviceSetup& setup, bool same_device, const ColorOverrides& overrides,
              rgbd::RgbdCamera* camera);

}  // namespace palpate::capture
