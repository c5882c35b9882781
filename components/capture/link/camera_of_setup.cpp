// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/link/camera_of_setup.hpp"

#include <algorithm>

namespace palpate::capture {

void AddColor(const DeviceSetup& setup, bool same_device, const ColorOverrides& overrides,
              rgbd::RgbdCamera* camera) {
  rgbd::CameraModel& color = camera->color;
  color = setup.color;
  if (color.width_px == 0) return;
  const ColorCalibration& reported = setup.color_calibration;
  const bool same_size =
      color.width_px == camera->depth.width_px && color.height_px == camera->depth.height_px;
  const bool other_camera = reported.model.has_value() || overrides.fx_px.has_value();
  camera->color_registered = overrides.registered.value_or(
      reported.registered.value_or(same_device && same_size && !other_camera));
  if (camera->color_registered && same_size) {
    color = camera->depth;
    return;
  }
  color.fx_px = overrides.fx_px.value_or(color.fx_px);
  color.fy_px = overrides.fy_px.value_or(overrides.fx_px.value_or(color.fy_px));
  color.cx_px = overrides.cx_px.value_or(
      color.fx_px > 0.0 && reported.model ? color.cx_px : 0.5 * (color.width_px - 1));
  color.cy_px = overrides.cy_px.value_or(
      color.fx_px > 0.0 && reported.model ? color.cy_px : 0.5 * (color.height_px - 1));
  std::copy_n(overrides.distortion.begin(),
              std::min(overrides.distortion.size(), color.distortion.size()),
              color.distortion.begin());
  camera->color_registered = false;
  camera->T_depth_color = overrides.T_depth_color.value_or(
      reported.T_depth_color.value_or(Eigen::Isometry3d::Identity()));
}

rgbd::RgbdCamera CameraOfSetup(const DeviceSetup& setup, double depth_unit_m,
                               const ColorOverrides& overrides) {
  rgbd::RgbdCamera camera;
  camera.depth = setup.scan3d.camera;
  camera.depth_unit_m = depth_unit_m;
  camera.invalid_value = 0;
  camera.baseline_m = setup.scan3d.baseline_m;
  AddColor(setup, true, overrides, &camera);
  return camera;
}

}  // namespace palpate::capture
