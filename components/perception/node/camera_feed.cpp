// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/camera_feed.hpp"

#include <numeric>
#include <string_view>
#include <vector>

namespace palpate::perception {

Status CameraFeed::CheckIsNew(const FrameSet& set) {
  const std::vector<std::uint16_t>& depths = set.depth->values;
  const std::string_view bytes(reinterpret_cast<const char*>(depths.data()),
                               depths.size() * sizeof(std::uint16_t));
  const auto sum = std::accumulate(depths.begin(), depths.end(), std::uint64_t{0});
  if (!repetition_.IsRepeated(bytes, static_cast<double>(sum))) return Status::Ok();
  return {StatusCode::kStale, streams_->depths().ros_name() +
                                  ": the image is the one before, pixel for pixel, under a new "
                                  "stamp: the camera or its process is stuck"};
}

CameraOrigin CameraFeed::OriginOf(const FrameSet* set) const {
  CameraOrigin origin;
  origin.name = name_;
  origin.device = streams_->device();
  if (set == nullptr) {
    origin.epoch = last_epoch_;
    if (set_) origin.picture = rgbd::PictureOf(set_->depth);
  } else if (set->facts) {
    origin.frame_counter = set->facts->counter;
    origin.epoch = set->facts->epoch;
  }
  return origin;
}

CameraJob CameraFeed::MakeJob(FrameSet& set, const rgbd::RgbdCamera& camera,
                              std::int64_t stamp_ns) {
  CameraJob job;
  job.images.stamp_ns = stamp_ns;
  job.images.depth = std::move(*set.depth);
  if (set.color) job.images.color = std::move(*set.color);
  if (Resets()) {
    job.reset = config_;
    sigma_px_ = streams_->subpixel_sigma_px();
    job.reset->depth_subpixel_px = sigma_px_.value_or(config_.depth_subpixel_px);
  }
  if (job.reset || set_setups_ != streams_->setups() || !IsSameCamera(*set_, camera)) {
    job.camera = set_ = camera;
    set_setups_ = streams_->setups();
  }
  is_forgotten_ = false;
  last_epoch_ = set.facts ? set.facts->epoch : 0;
  return job;
}

}  // namespace palpate::perception
