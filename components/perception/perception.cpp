// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/perception.hpp"

#include <utility>

#include "components/perception/camera_perception.hpp"
#include "components/perception/contacts/contact_tracker.hpp"
#include "components/perception/make_segmenter.hpp"

namespace palpate::perception {

struct Perception::Parts {
  CameraPerception camera;
  ContactTracker tracker;
  Observation observation;
};

Perception::Perception(const Config& config, std::unique_ptr<Segmenter> segmenter)
    : parts_(new Parts{.camera = CameraPerception(config, std::move(segmenter)),
                       .tracker = ContactTracker(config.tracking),
                       .observation = {}}) {}

Perception::Perception(const Config& config) : Perception(config, MakeSegmenter(config)) {}

Perception::~Perception() = default;

void Perception::SetCamera(const rgbd::RgbdCamera& camera) {
  parts_->camera.SetCamera(camera);
  parts_->tracker.Forget();
}

const Observation& Perception::Update(const rgbd::RgbdFrame& frame,
                                      const PredictedSurface* predicted) {
  Observation& observation = parts_->observation;
  observation.stamp_ns = frame.stamp_ns;
  // A frame that cannot be used shows no contact; hysteresis bridges a few of them.
  const auto& located = parts_->camera.Look(frame, predicted, &observation);
  observation.contacts = parts_->tracker.Update(located);
  return observation;
}

}  // namespace palpate::perception
