// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/camera_publisher.hpp"

#include "libs/geometry/frames.hpp"

namespace palpate::dds {

CameraPublisher::CameraPublisher(Participant& participant, const std::function<void()>& on_change)
    : depth_{participant.CreateWriter(kDepthImageTopic, on_change)},
      color_{participant.CreateWriter(kColorImageTopic, on_change)},
      depth_camera_{participant.CreateWriter(kDepthCameraInfoTopic)},
      color_camera_{participant.CreateWriter(kColorCameraInfoTopic)},
      info_{participant.CreateWriter(kFrameInfoTopic, on_change)},
      setup_{participant.CreateWriter(kCameraSetupTopic)},
      transforms_{participant} {}

bool CameraPublisher::PublishCamera(const rgbd::RgbdCamera& camera, const CameraIdentity& identity,
                                    std::int64_t stamp_ns,
                                    const std::optional<Eigen::Isometry3d>& T_robot_camera) {
  bool sent = setup_.Write(ToCameraSetup(camera, identity, stamp_ns));
  sent &=
      depth_camera_.Write(ToCameraInfo(camera.depth, stamp_ns, geometry::kCameraDepthOpticalFrame));
  if (T_robot_camera) {
    sent &= transforms_.Set(geometry::kRobotFrame, geometry::kCameraDepthOpticalFrame,
                            *T_robot_camera, stamp_ns);
  }
  if (camera.color.width_px == 0) return sent;
  if (!camera.color_registered) {
    sent &= transforms_.Set(geometry::kCameraDepthOpticalFrame, geometry::kCameraColorOpticalFrame,
                            camera.T_depth_color, stamp_ns);
  }
  return color_camera_.Write(ToCameraInfo(camera.color, stamp_ns, ColorFrameId(camera))) && sent;
}

bool CameraPublisher::PublishFrame(const rgbd::RgbdCamera& camera, const rgbd::RgbdFrame& images,
                                   std::int64_t stamp_ns,
                                   const idl::palpate_msgs::FrameInfo& info) {
  bool sent =
      depth_.Write(depth_message_.Of(images.depth, stamp_ns, geometry::kCameraDepthOpticalFrame));
  if (!images.color.empty()) {
    sent &= color_.Write(color_message_.Of(images.color, stamp_ns, ColorFrameId(camera)));
  }
  return info_.Write(info) && sent;
}

bool CameraPublisher::WaitUntilReceived(std::chrono::nanoseconds at_most) {
  return depth_.WaitUntilReceived(at_most) && color_.WaitUntilReceived(at_most) &&
         info_.WaitUntilReceived(at_most);
}

}  // namespace palpate::dds
