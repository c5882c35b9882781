// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/camera_perception.hpp"

#include <optional>
#include <string>
#include <utility>

#include "components/perception/contacts/contact_locator.hpp"
#include "components/perception/markers/fiducial_detector.hpp"
#include "components/perception/texture/texture_tracker.hpp"
#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::perception {

struct CameraPerception::Parts {
  std::unique_ptr<Segmenter> segmenter;
  ContactLocator locator;
  std::optional<FiducialDetector> markers;
  TextureConfig texture_config;
  std::optional<TextureTracker> texture;
  std::optional<rgbd::RgbdCamera> camera;
};

CameraPerception::CameraPerception(const Config& config, std::unique_ptr<Segmenter> segmenter)
    : parts_(new Parts{.segmenter = std::move(segmenter),
                       .locator = ContactLocator(config.contacts),
                       .markers = {},
                       .texture_config = config.texture,
                       .texture = {},
                       .camera = {}}) {
  PALPATE_CHECK(parts_->segmenter != nullptr);
  if (config.max_z_m <= config.min_z_m) {
    throw InputError("max_z_m is " + FormatNumber(config.max_z_m) +
                     "; must be larger than min_z_m, " + FormatNumber(config.min_z_m));
  }
  if (!config.markers.color_rgb.empty()) {
    parts_->markers.emplace(FiducialsOf(config));
  } else if (!config.markers.names.empty()) {
    throw InputError("markers.names has names of colours, but markers.color_rgb is empty");
  }
}

CameraPerception::~CameraPerception() = default;
CameraPerception::CameraPerception(CameraPerception&&) noexcept = default;
CameraPerception& CameraPerception::operator=(CameraPerception&&) noexcept = default;

void CameraPerception::SetCamera(const rgbd::RgbdCamera& camera) {
  parts_->segmenter->SetCamera(camera);
  if (parts_->markers) parts_->markers->SetCamera(camera);
  if (parts_->camera == camera) return;  // it shows the same robot: its points stay known
  parts_->camera = camera;
  const bool follows = camera.color.width_px > 0 && parts_->texture_config.max_points > 0;
  parts_->texture.reset();
  if (follows) parts_->texture.emplace(parts_->texture_config, camera);
}

const std::vector<DetectedContact>& CameraPerception::Look(const rgbd::RgbdFrame& frame,
                                                           const PredictedSurface* predicted,
                                                           CameraView* seen) {
  PALPATE_CHECK(parts_->camera.has_value());
  seen->frame = parts_->segmenter->Segment(frame, predicted);
  if (parts_->markers) seen->markers = parts_->markers->Detect(frame);
  if (parts_->texture) {
    seen->texture =
        parts_->texture->Follow(frame, parts_->segmenter->FittedSurface(), seen->frame.object);
    if (const auto& note = parts_->texture->note()) seen->frame.notes.push_back(*note);
  }
  return parts_->locator.Locate(seen->frame.robot, seen->frame.object,
                                parts_->segmenter->FittedSurface());
}

}  // namespace palpate::perception
