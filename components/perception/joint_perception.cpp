// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/joint_perception.hpp"

#include <utility>

#include "components/perception/make_segmenter.hpp"
#include "libs/core/check.hpp"

namespace palpate::perception {

namespace {

DetectedContact Mapped(DetectedContact contact, const Eigen::Isometry3d& T_first_camera) {
  const Eigen::Matrix3d R_first_camera = T_first_camera.linear();
  contact.position_m = T_first_camera * contact.position_m;
  contact.covariance_m2 = R_first_camera * contact.covariance_m2 * R_first_camera.transpose();
  return contact;
}

}  // namespace

const Status& JointObservation::status() const {
  for (const CameraView& view : views) {
    if (view.frame.status.ok()) return view.frame.status;
  }
  return views.front().frame.status;
}

JointPerception::JointPerception(const Config& config) : JointPerception(config, MakeSegmenter) {}

JointPerception::JointPerception(const Config& config, SegmenterMaker make_segmenter)
    : config_(config), make_segmenter_(std::move(make_segmenter)), tracker_(config.tracking) {
  HaveCameras(1);
}

void JointPerception::HaveCameras(std::size_t count) {
  while (cameras_.size() < count) {
    cameras_.emplace_back(config_, make_segmenter_(config_));
  }
  if (observation_.views.size() < count) observation_.views.resize(count);
}

void JointPerception::Open(const std::vector<std::optional<rgbd::RgbdCamera>>& cameras) {
  PALPATE_CHECK(!cameras.empty());
  HaveCameras(cameras.size());
  for (std::size_t k = 0; k < cameras.size(); ++k) {
    if (cameras[k]) cameras_[k].SetCamera(*cameras[k]);
  }
  observation_.views.resize(cameras.size());
  tracker_.Forget();
}

void JointPerception::SetCamera(std::size_t number, const rgbd::RgbdCamera& camera) {
  HaveCameras(number + 1);
  cameras_[number].SetCamera(camera);
  if (number == 0) tracker_.Forget();
}

void JointPerception::Restart(std::size_t number, const Config& config) {
  HaveCameras(number + 1);
  cameras_[number] = CameraPerception(config, make_segmenter_(config));
}

const JointObservation& JointPerception::Update(std::int64_t stamp_ns,
                                                const std::vector<CameraFrame>& frames) {
  HaveCameras(frames.size());
  PALPATE_CHECK(frames.size() == observation_.views.size(), frames.size());
  observation_.stamp_ns = stamp_ns;
  located_.clear();
  for (std::size_t k = 0; k < frames.size(); ++k) {
    CameraView& view = observation_.views[k];
    if (frames[k].images == nullptr) {
      view = {};
      view.frame.status = {StatusCode::kStale, "the camera has no image of this time"};
      continue;
    }
    // A frame that cannot be used shows no contact; hysteresis bridges a few of them.
    const auto& located = cameras_[k].Look(*frames[k].images, frames[k].predicted, &view);
    if (k == 0) {
      located_ = located;
      continue;
    }
    const Eigen::Isometry3d T_first_camera =
        frames[0].T_robot_camera.inverse() * frames[k].T_robot_camera;
    std::vector<DetectedContact> mapped;
    for (const DetectedContact& contact : located) {
      mapped.push_back(Mapped(contact, T_first_camera));
    }
    JoinContacts(mapped, &located_);
  }
  observation_.contacts = tracker_.Update(located_);
  return observation_;
}

}  // namespace palpate::perception
