// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/perception/observation.hpp"
#include "libs/rgbd/rgbd_camera.hpp"

namespace palpate::perception {

/// Sorts a frame into robot, objects and background. Never throws in Segment: what is wrong with a
/// frame stands in its status.
class Segmenter {
 public:
  virtual ~Segmenter() = default;

  /// A camera: the state of another camera is void.
  virtual void SetCamera(const rgbd::RgbdCamera& camera) = 0;

  /// `predicted`: nullptr where the model's state is not known. The result holds until the next
  /// call.
  virtual const SegmentedFrame& Segment(const rgbd::RgbdFrame& frame,
                                        const PredictedSurface* predicted) = 0;

  /// What was predicted of the robot's surface for the last frame, moved onto what was measured,
  /// with the sides that the camera does not see; nullptr where that was not done. Holds until the
  /// next call of Segment.
  virtual const PredictedSurface* FittedSurface() const { return nullptr; }
};

}  // namespace palpate::perception
