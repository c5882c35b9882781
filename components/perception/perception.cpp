// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/perception.hpp"

#include <optional>
#include <string>
#include <utility>

#include "components/perception/contacts/contact_locator.hpp"
#include "components/perception/contacts/contact_tracker.hpp"
#include "components/perception/make_segmenter.hpp"
#include "components/perception/markers/fiducial_detector.hpp"
#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::perception {

struct Perception::Parts {
  std::unique_ptr<Segmenter> segmenter;
  ContactLocator locator;
  ContactTracker tracker;
  std::optional<FiducialDetector> markers;
  Observation observation;
  bool has_camera = false;
};

Perception::Perception(const Config& config, std::unique_ptr<Segmenter> segmenter)
    : parts_(new Parts{.segmenter = std::move(segmenter),
                       .locator = ContactLocator(config.contacts),
                       .tracker = ContactTracker(config.tracking),
                       .markers = {},
                       .observation = {}}) {
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

Perception::Perception(const Config& config) : Perception(config, MakeSegmenter(config)) {}

Perception::~Perception() = default;

void Perception::SetCamera(const rgbd::RgbdCamera& camera) {
  parts_->segmenter->SetCamera(camera);
  parts_->tracker.Forget();
  if (parts_->markers) parts_->markers->SetCamera(camera);
  parts_->has_camera = true;
}

const Observation& Perception::Update(const rgbd::RgbdFrame& frame,
                                      const PredictedSurface* predicted) {
  PALPATE_CHECK(parts_->has_camera);
  Observation& observation = parts_->observation;
  observation.stamp_ns = frame.stamp_ns;
  observation.frame = parts_->segmenter->Segment(frame, predicted);
  // A frame that cannot be used shows no contact; hysteresis bridges a few of them.
  const auto& located = parts_->locator.Locate(observation.frame.robot, observation.frame.object,
                                               parts_->segmenter->FittedSurface());
  observation.contacts = parts_->tracker.Update(located);
  if (parts_->markers) observation.markers = parts_->markers->Detect(frame);
  return observation;
}

}  // namespace palpate::perception
