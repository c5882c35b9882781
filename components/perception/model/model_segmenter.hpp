// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>

#include "components/perception/config.hpp"
#include "components/perception/model/pixel_region.hpp"
#include "components/perception/segmenter.hpp"

namespace palpate::perception {

struct ModelSegmenterTuning {
  /// Slope of z across one surface, m/m, and sigmas of the difference of neighbours (3 sigmas of a
  /// difference): beyond both there is a depth edge. Larger: surfaces merge; smaller: steep parts
  /// are cut.
  float steepest_slope = 3.7f;
  float step_sigmas = 4.2f;
  /// Evidence between this and that of the robot is ambiguous. Lower: fewer object pixels, purer.
  float ambiguous_evidence = -0.5f;
  /// Neighbours on the same surface, below which a pixel is at a depth edge. More: purer clouds
  /// that lose thin parts.
  int least_support_px = 2;
  std::int64_t least_patch_px = 25;  ///< of one label; more: purer clouds, small objects are lost
  int background_step_px = 8;        ///< of samples for planes; larger: faster, less exact
  Eigen::Index robot_points = 400;   ///< of the prediction for planes; more: slower
  /// Without a prediction: evidence of a colour from which it is the robot's, and the share of the
  /// largest patch that other patches must have. Larger: purer, less complete robot clouds.
  float color_evidence = 1.0f;
  double patch_share = 0.03;
  int site_step_px = 4;   ///< of robot samples without a prediction; larger: faster, less exact
  int color_step_px = 4;  ///< of pixels whose colours are compared; larger: faster, noisier
  /// Share of the fitted surface with measured points, in the first frame and later, below which
  /// another fit is tried. Larger: more time, fewer wrong fits.
  double first_agreement = 0.98;
  double agreement = 0.8;
  double farther =
      3.0;  ///< reach of that fit, in largest errors; larger: from farther, less robust
  /// Share below which the measurement is not the robot and no fit is tried. Smaller: more time.
  double least_agreement = 0.25;
};

/// Segments by the model's predicted surface, fitted to the frame; by a colour model from pixels
/// where prediction and depth agree; and by depth edges. Geometry decides where it can: a tool of
/// the robot's own colour stands out of the surface. Colours decide where it cannot: at the rim of
/// a contact. The colour model is re-initialised when the light changes, from the same frame.
/// Without a prediction the colour model, or Config::robot_color_rgb, are used alone.
class ModelSegmenter : public Segmenter {
 public:
  /// Throws InputError for settings that contradict each other.
  explicit ModelSegmenter(const Config& config, const ModelSegmenterTuning& tuning = {});
  ~ModelSegmenter() override;

  void SetCamera(const rgbd::RgbdCamera& camera) override;
  /// After SetCamera.
  const SegmentedFrame& Segment(const rgbd::RgbdFrame& frame,
                                const PredictedSurface* predicted) override;
  const PredictedSurface* FittedSurface() const override;

  /// Label of each pixel of the last frame; outside of the region it is background.
  const PixelRegion& region() const;

 private:
  struct Parts;
  Config config_;
  ModelSegmenterTuning tuning_;
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::perception
