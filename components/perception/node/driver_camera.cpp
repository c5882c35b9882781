// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/driver_camera.hpp"

#include "components/perception/node/convert_driver.hpp"

namespace palpate::perception {

bool DriverStream::is_rectified() const {
  std::string image = image_topic;
  for (const std::string transport : {"/compressedDepth", "/compressed"}) {
    if (image.ends_with(transport)) image.resize(image.size() - transport.size());
  }
  return image.substr(image.rfind('/') + 1).starts_with("image_rect");
}

void DriverStream::SetInfo(const idl::sensor_msgs::CameraInfo& message) {
  lens_status = FromDriverInfo(message, is_rectified(), &lens.emplace());
}

Status DriverStream::CheckLens() const {
  if (!lens) {
    return {StatusCode::kNoCalibration,
            "no " + info_topic + " has come, so " + image_topic +
                " has no intrinsics: the driver publishes them beside the image (--remap)"};
  }
  if (!lens_status.ok()) return {lens_status.code(), info_topic + ": " + lens_status.message()};
  if (lens->fx_px > 0.0 && lens->fy_px > 0.0) return Status::Ok();
  return {StatusCode::kNoCalibration,
          info_topic +
              " has no intrinsics (K is zero): calibrate the camera, or have the driver "
              "publish its factory calibration"};
}

Status DriverCamera::CameraOf(bool with_color, double depth_unit_m,
                              rgbd::RgbdCamera* camera) const {
  if (Status status = depth_.CheckLens(); !status.ok()) return status;
  rgbd::RgbdCamera found;
  found.depth = *depth_.lens;
  found.depth_unit_m = depth_unit_m;
  found.baseline_m = baseline_m_;
  if (with_color) {
    if (Status status = AddColor(&found); !status.ok()) return status;
  }
  *camera = found;
  return Status::Ok();
}

Status DriverCamera::AddColor(rgbd::RgbdCamera* camera) const {
  if (Status status = color_.CheckLens(); !status.ok()) return status;
  camera->color = *color_.lens;
  if (given_) {
    camera->T_depth_color = *given_;
    return Status::Ok();
  }
  if (color_.frame == depth_.frame) {
    camera->color_registered = *color_.lens == *depth_.lens;
    return Status::Ok();
  }
  const auto T_depth_color = frames_.Find(depth_.frame, color_.frame);
  if (!T_depth_color) {
    return {
        StatusCode::kNoCalibration,
        "colour is in frame '" + color_.frame + "', depth in '" + depth_.frame +
            "', and no transforms on /tf_static or /tf join them: let the driver align depth to "
            "colour or publish its frames, or set camera.T_depth_color"};
  }
  camera->T_depth_color = *T_depth_color;
  return Status::Ok();
}

}  // namespace palpate::perception
