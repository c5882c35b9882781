// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/camera_inputs.hpp"

#include "libs/dds/camera_messages.hpp"
#include "libs/dds/stamp.hpp"

namespace palpate::perception {

namespace {

Status Missing(const std::string& what) { return {StatusCode::kNoCalibration, what}; }

Status About(const std::string& topic, const Status& status) {
  return status.ok() ? status : Status(status.code(), topic + ": " + status.message());
}

}  // namespace

void CameraInputs::SetSetup(const idl::palpate_msgs::CameraSetup& message) {
  Received<CameraSetup> received{dds::StampNs(message.header.stamp), {}, {}};
  received.status = About(prefix_ + "/setup", FromCameraSetup(message, &received.value));
  setup_ = std::move(received);
  ++setups_;
}

void CameraInputs::SetLens(const idl::sensor_msgs::CameraInfo& message, Lens* lens) {
  Received<rgbd::CameraModel> received{dds::StampNs(message.header.stamp), {}, {}};
  received.status = dds::FromCameraInfo(message, &received.value);
  *lens = std::move(received);
}

void CameraInputs::SetDepthLens(const idl::sensor_msgs::CameraInfo& message) {
  SetLens(message, &depth_);
}

void CameraInputs::SetColorLens(const idl::sensor_msgs::CameraInfo& message) {
  SetLens(message, &color_);
}

Status CameraInputs::CameraOf(std::uint32_t epoch, rgbd::RgbdCamera* camera) const {
  if (!setup_) return Missing("no " + prefix_ + "/setup has come");
  if (!setup_->status.ok()) return setup_->status;
  if (setup_->value.epoch != epoch) {
    return Missing("a frame of epoch " + std::to_string(epoch) + ", but the " + prefix_ +
                   "/setup of epoch " + std::to_string(setup_->value.epoch));
  }
  if (Status status = CheckDepthLens(); !status.ok()) return status;
  if (Status status = CheckColorLens(); !status.ok()) return status;
  *camera = setup_->value.camera;
  camera->depth = depth_->value;
  if (!has_color_lens()) return Status::Ok();
  camera->color = color_->value;
  if (camera->color.fx_px == 0.0) camera->color = depth_->value;
  return Status::Ok();
}

Status CameraInputs::CheckDepthLens() const {
  if (!BelongsToSetup(depth_))
    return Missing("no " + prefix_ + "/depth/camera_info of this epoch has come");
  if (!depth_->status.ok()) return About(prefix_ + "/depth/camera_info", depth_->status);
  if (depth_->value.fx_px > 0.0 && depth_->value.fy_px > 0.0) return Status::Ok();
  return Missing(prefix_ + "/depth/camera_info: the camera is not calibrated");
}

Status CameraInputs::CheckColorLens() const {
  if (!has_color_lens()) return Status::Ok();
  if (!color_->status.ok()) return About(prefix_ + "/color/camera_info", color_->status);
  const rgbd::CameraModel& color = color_->value;
  const rgbd::CameraModel& depth = depth_->value;
  if (setup_->value.camera.color_registered) {
    if (color.width_px == depth.width_px && color.height_px == depth.height_px) {
      return Status::Ok();
    }
    return {StatusCode::kInvalidInput,
            prefix_ + "/color/camera_info: registered colour of another size than the depth"};
  }
  if (color.fx_px > 0.0 && color.fy_px > 0.0) return Status::Ok();
  return Missing(prefix_ + "/color/camera_info: the camera is not calibrated");
}

}  // namespace palpate::perception
