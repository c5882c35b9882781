// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/genicam_source.hpp"

#include <utility>

namespace palpate::capture {

namespace {

constexpr double kUsualPeriod_s = 1.0 / 30.0;

/// How far a state is from streaming, for the worse of two.
int Trouble(const SourceHealth& health) {
  switch (health.state) {
    case SourceState::kStream: return 0;
    case SourceState::kStale: return 1;
    case SourceState::kConfigure: return 2;
    case SourceState::kOpen: return 3;
    default: return 4;
  }
}

}  // namespace

GenicamSource::GenicamSource(GenicamSettings settings)
    : settings_{std::move(settings)}, queue_{settings_.queue_frames} {
  if (settings_.color) {
    color_link_ = std::make_unique<CameraLink>(
        *settings_.color, [this](const DeviceSetup& setup, double) { OnColorSetup(setup); },
        [this](std::shared_ptr<SourceFrame> frame) { OnColorFrame(std::move(frame)); });
  }
  depth_link_ = std::make_unique<CameraLink>(
      settings_.depth,
      [this](const DeviceSetup& setup, double unit_m) { OnDepthSetup(setup, unit_m); },
      [this](std::shared_ptr<SourceFrame> frame) { OnDepthFrame(std::move(frame)); });
}

GenicamSource::~GenicamSource() {
  queue_.Close();
  depth_link_.reset();
  color_link_.reset();
}

void GenicamSource::OnDepthSetup(const DeviceSetup& setup, double depth_unit_m) {
  const std::lock_guard lock(mutex_);
  depth_setup_ = setup;
  depth_unit_m_ = depth_unit_m;
  RebuildCamera();
}

void GenicamSource::OnColorSetup(const DeviceSetup& setup) {
  const std::lock_guard lock(mutex_);
  color_setup_ = setup;
  RebuildCamera();
}

void GenicamSource::RebuildCamera() {
  ++epoch_;
  if (!depth_setup_ || (settings_.color && !color_setup_)) return;
  auto camera = std::make_shared<rgbd::RgbdCamera>(
      CameraOfSetup(*depth_setup_, depth_unit_m_, settings_.color_overrides));
  if (color_setup_) AddColor(*color_setup_, false, settings_.color_overrides, camera.get());
  camera_ = std::move(camera);
  if (!settings_.color) return;
  if (pairing_) unpaired_before_ += pairing_->unpaired();
  const double period_s = depth_setup_->period_s > 0.0 ? depth_setup_->period_s : kUsualPeriod_s;
  pairing_.emplace(static_cast<std::int64_t>(0.5e9 * period_s));
}

void GenicamSource::Publish(std::shared_ptr<SourceFrame> frame) {
  frame->camera = camera_;
  frame->facts.epoch = epoch_;
  queue_.Push(std::move(frame));
}

void GenicamSource::OnDepthFrame(std::shared_ptr<SourceFrame> frame) {
  const std::lock_guard lock(mutex_);
  if (!settings_.color) return Publish(std::move(frame));
  if (!pairing_) return;  // the colour camera is not there yet
  pairing_->AddDepth(std::move(frame));
  while (auto pair = pairing_->Next()) Publish(std::move(*pair));
}

void GenicamSource::OnColorFrame(std::shared_ptr<SourceFrame> frame) {
  const std::lock_guard lock(mutex_);
  if (!pairing_) return;
  pairing_->AddColor(std::move(frame));
  while (auto pair = pairing_->Next()) Publish(std::move(*pair));
}

SourceHealth GenicamSource::Health() const {
  SourceHealth health = depth_link_->Health();
  if (color_link_) {
    const SourceHealth color = color_link_->Health();
    if (Trouble(color) > Trouble(health)) {
      health.state = color.state;
      health.reason = "colour camera: " + color.reason;
    }
    health.device += " + " + color.device;
    health.frames_failed += color.frames_failed;
    health.frames_dropped += color.frames_dropped;
    health.packets_lost += color.packets_lost;
    health.packets_resent += color.packets_resent;
    health.socket_drops += color.socket_drops;
    health.notes.insert(health.notes.end(), color.notes.begin(), color.notes.end());
  }
  health.frames_dropped += queue_.dropped();
  const std::lock_guard lock(mutex_);
  health.epoch = epoch_;
  health.frames_dropped += unpaired_before_ + (pairing_ ? pairing_->unpaired() : 0);
  return health;
}

}  // namespace palpate::capture
