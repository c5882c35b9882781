// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/perception/observation.hpp"
#include "libs/rgbd/rgbd_camera.hpp"

namespace palpate::perception {

/// Segments a frame into robot, objects and background. Segment never throws: errors of a frame are
/// in its status.
class Segmenter {
 public:
  virtual ~Segmenter() = default;

  /// A camera: discards the state of another camera.
  virtual void SetCamera(const rgbd::RgbdCamera& camera) = 0;

  /// `predicted`: nullptr where the model's state is unknown. The result holds until the next
  /// call.
  virtual const SegmentedFrame& Segment(const rgbd::RgbdFrame& frame,
                                        const PredictedSurface* predicted) = 0;

  /// The predicted surface of the robot, registered to the last frame, with its occluded sides;
  /// nullptr where there is none. Holds until the next call of Segment.
  virtual const PredictedSurface* FittedSurface() const { return nullptr; }
};

}  // namespace palpate::perception
