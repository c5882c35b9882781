// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <memory>

#include "components/perception/config.hpp"
#include "components/perception/model/pixel_region.hpp"
#include "components/perception/segmenter.hpp"

namespace palpate::perception {

/// Segments by where the model predicts the robot's surface, fitted to the frame; by a colour model
/// from pixels where prediction and depth agree; and by depth edges. Geometry decides where it can:
/// a tool of the robot's own colour stands out of the surface. Colours decide where it cannot: at
/// the rim of a contact. The model is re-initialised when the light changes, from the same
/// frame. Without a prediction the colour model, or Config::robot_color_rgb, are used
/// alone.
class ModelSegmenter : public Segmenter {
 public:
  /// Throws InputError for settings that do not go together.
  explicit ModelSegmenter(const Config& config);
  ~ModelSegmenter() override;

  void SetCamera(const rgbd::RgbdCamera& camera) override;
  /// After SetCamera.
  const SegmentedFrame& Segment(const rgbd::RgbdFrame& frame,
                                const PredictedSurface* predicted) override;
  const PredictedSurface* FittedSurface() const override;

  /// What each pixel of the last frame was taken for; outside of the region it is background.
  const PixelRegion& region() const;

 private:
  struct Parts;
  Config config_;
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::perception
