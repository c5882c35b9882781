// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <memory>

#include "components/perception/config.hpp"
#include "components/perception/observation.hpp"
#include "components/perception/segmenter.hpp"
#include "libs/rgbd/rgbd_camera.hpp"

namespace palpate::perception {

/// From a frame of the camera to the points and contacts of the robot (section V.A of the paper),
/// and to the markers on it where their colour is set. Frames come in order; colour model and
/// contacts go on from one to the next. The same frames and predictions give the same bits.
class Perception {
 public:
  /// Throws InputError for settings that contradict each other.
  explicit Perception(const Config& config);
  /// With a given segmenter.
  Perception(const Config& config, std::unique_ptr<Segmenter> segmenter);
  ~Perception();

  /// A camera, or the same one reopened: removes all contacts. Before the first Update.
  void SetCamera(const rgbd::RgbdCamera& camera);

  /// `predicted`: nullptr where the model's state is unknown. The observation holds until the
  /// next call.
  const Observation& Update(const rgbd::RgbdFrame& frame, const PredictedSurface* predicted);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::perception
