// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/camera_publisher.hpp"

#include "libs/geometry/frames.hpp"

namespace palpate::dds {

CameraPublisher::CameraPublisher(Participant& participant, const std::function<void()>& on_change,
                                 const std::string& camera)
    : of_{TopicsOf(camera)},
      depth_{participant.CreateWriter(of_.depth, on_change, camera)},
      color_{participant.CreateWriter(of_.color, on_change, camera)},
      depth_camera_{participant.CreateWriter(of_.depth_lens, {}, camera)},
      color_camera_{participant.CreateWriter(of_.color_lens, {}, camera)},
      info_{participant.CreateWriter(of_.frame_info, on_change, camera)},
      setup_{participant.CreateWriter(of_.setup, {}, camera)},
      transforms_{participant} {}

bool CameraPublisher::PublishCamera(const rgbd::RgbdCamera& camera, const CameraIdentity& identity,
                                    std::int64_t stamp_ns,
                                    const std::optional<Eigen::Isometry3d>& T_robot_camera) {
  bool sent = setup_.Write(ToCameraSetup(camera, identity, stamp_ns, of_.depth_frame));
  sent &= depth_camera_.Write(ToCameraInfo(camera.depth, stamp_ns, of_.depth_frame));
  if (T_robot_camera) {
    sent &= transforms_.Set(geometry::kRobotFrame, of_.depth_frame, *T_robot_camera, stamp_ns);
  }
  if (camera.color.width_px == 0) return sent;
  if (!camera.color_registered) {
    sent &= transforms_.Set(of_.depth_frame, of_.color_frame, camera.T_depth_color, stamp_ns);
  }
  return color_camera_.Write(ToCameraInfo(camera.color, stamp_ns, ColorFrame(camera))) && sent;
}

bool CameraPublisher::PublishFrame(const rgbd::RgbdCamera& camera, const rgbd::RgbdFrame& images,
                                   std::int64_t stamp_ns,
                                   const idl::palpate_msgs::FrameInfo& info) {
  bool sent = depth_.Write(depth_message_.Of(images.depth, stamp_ns, of_.depth_frame));
  if (!images.color.empty()) {
    sent &= color_.Write(color_message_.Of(images.color, stamp_ns, ColorFrame(camera)));
  }
  return info_.Write(info) && sent;
}

bool CameraPublisher::WaitUntilReceived(std::chrono::nanoseconds at_most) {
  return depth_.WaitUntilReceived(at_most) && color_.WaitUntilReceived(at_most) &&
         info_.WaitUntilReceived(at_most);
}

}  // namespace palpate::dds
