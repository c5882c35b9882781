// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/player/node/image_publisher.hpp"

#include <limits>

#include "libs/core/clock.hpp"
#include "libs/dds/stamp.hpp"

namespace palpate::player {

namespace {

dds::CameraIdentity IdentityOf(const experiment::Experiment& experiment) {
  dds::CameraIdentity identity;
  identity.device = experiment.folder.filename().string();
  identity.model = "recording";
  if (experiment.depth_noise) identity.subpixel_sigma_px = experiment.depth_noise->subpixel_px;
  return identity;
}

}  // namespace

ImagePublisher::ImagePublisher(dds::Participant& participant,
                               const experiment::Experiment& experiment,
                               const std::function<void()>& on_change, const std::string& camera)
    : camera_{participant, on_change, camera}, identity_{IdentityOf(experiment)} {}

bool ImagePublisher::Publish(const ImageSet& images, std::int64_t stamp_ns) {
  const rgbd::RgbdCamera& camera = images.sequence->camera;
  bool sent = true;
  if (images.sequence != last_.sequence || images.index < last_.index) {
    ++identity_.epoch;
    sent = camera_.PublishCamera(camera, identity_, stamp_ns, images.T_robot_camera);
  }
  const bool again = images.sequence == last_.sequence && images.index == last_.index;
  if (!again) images.sequence->Read(images.index, &frame_);
  last_ = images;
  dds::Message<idl::palpate_msgs::FrameInfo> info;
  dds::SetHeader(info->header, stamp_ns, camera_.depth_frame());
  info->counter = counter_++;
  info->frame_id = images.index;
  info->epoch = identity_.epoch;
  dds::SetText(info->device, identity_.device);
  dds::SetText(info->clock_source, "replay");
  info->stamp_device_ns = images.t_ns;
  info->stamp_host_ns = stamp_ns;
  info->stamp_receive_ns = WallNow_ns();
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  info->exposure_s = info->gain_db = info->temperature_deg_c = info->valid_ratio = kUnknown;
  info->depth_unit_m = camera.depth_unit_m;
  info->invalid_value = static_cast<std::uint32_t>(camera.invalid_value);
  return camera_.PublishFrame(camera, frame_, stamp_ns, *info) && sent;
}

}  // namespace palpate::player
