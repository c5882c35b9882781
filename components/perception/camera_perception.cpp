// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/camera_perception.hpp"

#include <optional>
#include <string>
#include <utility>

#include "components/perception/contacts/contact_locator.hpp"
#include "components/perception/markers/fiducial_detector.hpp"
#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::perception {

struct CameraPerception::Parts {
  std::unique_ptr<Segmenter> segmenter;
  ContactLocator locator;
  std::optional<FiducialDetector> markers;
  bool has_camera = false;
};

CameraPerception::CameraPerception(const Config& config, std::unique_ptr<Segmenter> segmenter)
    : parts_(new Parts{.segmenter = std::move(segmenter),
                       .locator = ContactLocator(config.contacts),
                       .markers = {}}) {
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
  parts_->has_camera = true;
}

const std::vector<DetectedContact>& CameraPerception::Look(const rgbd::RgbdFrame& frame,
                                                           const PredictedSurface* predicted,
                                                           CameraView* seen) {
  PALPATE_CHECK(parts_->has_camera);
  seen->frame = parts_->segmenter->Segment(frame, predicted);
  if (parts_->markers) seen->markers = parts_->markers->Detect(frame);
  return parts_->locator.Locate(seen->frame.robot, seen->frame.object,
                                parts_->segmenter->FittedSurface());
}

}  // namespace palpate::perception
