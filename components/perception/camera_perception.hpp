// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <memory>
#include <vector>

#include "components/perception/config.hpp"
#include "components/perception/observation.hpp"
#include "components/perception/segmenter.hpp"
#include "libs/rgbd/rgbd_camera.hpp"

namespace palpate::perception {

/// What one camera shows in a frame: the robot's and the objects' points, contacts and markers.
/// Frames come in order; the colour model goes on from one to the next.
class CameraPerception {
 public:
  /// Throws InputError for settings that contradict each other.
  CameraPerception(const Config& config, std::unique_ptr<Segmenter> segmenter);
  ~CameraPerception();
  CameraPerception(CameraPerception&&) noexcept;
  CameraPerception& operator=(CameraPerception&&) noexcept;

  /// A camera, or the same one reopened. Before the first Look.
  void SetCamera(const rgbd::RgbdCamera& camera);

  /// What a frame shows, into `seen`, whose memory is used again. `predicted`: nullptr where the
  /// model's state is unknown. Returns its contacts without names, camera frame; they hold until
  /// the next call.
  const std::vector<DetectedContact>& Look(const rgbd::RgbdFrame& frame,
                                           const PredictedSurface* predicted, CameraView* seen);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::perception
