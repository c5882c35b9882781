// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/node/frame_publisher.hpp"

namespace palpate::capture {

FramePublisher::FramePublisher(dds::Participant& participant,
                               const std::function<void()>& on_change, double subpixel_sigma_px,
                               const std::string& camera)
    : topics_{participant, on_change, camera}, subpixel_sigma_px_{subpixel_sigma_px} {}

bool FramePublisher::Publish(const SourceFrame& frame, const SourceHealth& health) {
  const std::int64_t stamp_ns = frame.facts.stamp_host_ns;
  bool sent = true;
  if (frame.camera != camera_ || frame.facts.epoch != epoch_) {
    camera_ = frame.camera;
    epoch_ = frame.facts.epoch;
    sent = topics_.PublishCamera(
        *camera_, {health.device, health.model, epoch_, subpixel_sigma_px_}, stamp_ns);
  }
  SetFrameInfo(frame, health, counter_++, topics_.depth_frame(), &*info_message_);
  return topics_.PublishFrame(*camera_, frame.images, stamp_ns, *info_message_) && sent;
}

}  // namespace palpate::capture
