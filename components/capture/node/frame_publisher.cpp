// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/node/frame_publisher.hpp"

#include <utility>

#include "libs/geometry/frames.hpp"

namespace palpate::capture {

FramePublisher::FramePublisher(dds::Participant& participant, std::function<void()> on_change,
                               double subpixel_sigma_px)
    : depth_{participant.CreateWriter(dds::kDepthImageTopic)},
      color_{participant.CreateWriter(dds::kColorImageTopic)},
      depth_camera_{participant.CreateWriter(dds::kDepthCameraInfoTopic)},
      color_camera_{participant.CreateWriter(dds::kColorCameraInfoTopic)},
      info_{participant.CreateWriter(dds::kFrameInfoTopic, std::move(on_change))},
      setup_{participant.CreateWriter(dds::kCameraSetupTopic)},
      subpixel_sigma_px_{subpixel_sigma_px} {}

bool FramePublisher::PublishCamera(const SourceFrame& frame, const SourceHealth& health) {
  camera_ = frame.camera;
  epoch_ = frame.facts.epoch;
  const std::int64_t stamp_ns = frame.facts.stamp_host_ns;
  const rgbd::RgbdCamera& camera = *camera_;
  bool sent = setup_.Write(ToCameraSetup(camera, health, epoch_, stamp_ns, subpixel_sigma_px_));
  sent &=
      depth_camera_.Write(ToCameraInfo(camera.depth, stamp_ns, geometry::kCameraDepthOpticalFrame));
  if (camera.color.width_px == 0) return sent;
  return color_camera_.Write(ToCameraInfo(camera.color, stamp_ns, ColorFrameId(camera))) && sent;
}

bool FramePublisher::Publish(const SourceFrame& frame, const SourceHealth& health) {
  bool sent = true;
  if (frame.camera != camera_ || frame.facts.epoch != epoch_) sent = PublishCamera(frame, health);
  const std::int64_t stamp_ns = frame.facts.stamp_host_ns;
  sent &= depth_.Write(
      depth_message_.Of(frame.images.depth, stamp_ns, geometry::kCameraDepthOpticalFrame));
  if (!frame.images.color.empty()) {
    sent &=
        color_.Write(color_message_.Of(frame.images.color, stamp_ns, ColorFrameId(*frame.camera)));
  }
  SetFrameInfo(frame, health, counter_++, &*info_message_);
  return info_.Write(info_message_) && sent;
}

bool FramePublisher::WaitUntilReceived(std::chrono::nanoseconds at_most) {
  return depth_.WaitUntilReceived(at_most) && color_.WaitUntilReceived(at_most) &&
         info_.WaitUntilReceived(at_most);
}

}  // namespace palpate::capture
