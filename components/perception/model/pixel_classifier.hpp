// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "components/perception/config.hpp"
#include "components/perception/model/background_planes.hpp"
#include "components/perception/model/color_model.hpp"
#include "components/perception/model/disagreement.hpp"
#include "components/perception/model/pixel_region.hpp"
#include "components/perception/model/prediction_view.hpp"
#include "components/perception/model/rare_colors.hpp"
#include "components/perception/noise_law.hpp"
#include "components/perception/registered_frame.hpp"

namespace palpate::perception {

struct PixelClassifierTuning {
  ColorModelTuning colors = {};
  RareColorsTuning rare = {};
  /// Range of distances of everything but the robot (uniform density). Larger: more evidence for
  /// the robot near the surface.
  float elsewhere_m = 0.1f;
  float least_evidence = -8.0f;  ///< of the distance; lower: colour cannot overrule a wrong surface
  /// Sigmas inside the predicted surface over those outside, as only the robot, pushed in more than
  /// predicted, can be there. Larger: what is behind thin parts counts as the robot.
  float inside_sigmas = 2.0f;
  float background_evidence = -2.5f;  ///< of a plane; lower: a robot that touches it is lost
  /// Distance of pixels that train the robot's colour. Larger: objects near the surface train it.
  float sure_sigmas = 1.5f;
  /// Similarity of the robot's colours to the model below which the light has changed. Larger: more
  /// re-initialisations.
  double least_similarity = 0.85;
  /// Share of dark or saturated pixels above which colours are not used.
  double most_without_color = 0.5;
  int sample_step_px = 2;  ///< of pixels that train the colour model; larger: faster, noisier
  /// Distance from the fitted surface, as a share of its largest error, beyond which a pixel is not
  /// the robot. Smaller: errors of the fit train the colours of objects.
  float far_share = 0.5f;
  /// Weight of objects in the colours of everything but the robot, where the background has 1, and
  /// the number of their pixels at half of it. Larger weight: object colours decide sooner.
  float object_share = 0.4f;
  float few_objects_px = 50.0f;
  /// Share of the pixels of the fitted surface that are not occluded, and agree with it, below
  /// which no robot is seen. Larger: a robot with a wrong prediction is lost.
  double least_agreement = 0.25;
  /// Log ratio of a colour below which it is foreign to the robot. Higher: parts of the robot do
  /// not count in the fit of its surface.
  float foreign_log_ratio = -1.5f;
};

/// Evidence that each pixel of a region is the robot's: by its distance from the predicted surface,
/// and by its colour, which is estimated where the distance decides.
class PixelClassifier {
 public:
  PixelClassifier(const Config& config, const NoiseLaw& noise,
                  const PixelClassifierTuning& tuning = {});

  /// Sigma of the distance between a measured point of the robot and the fitted surface.
  float Sigma_m(float z_m) const;

  /// Sets evidence and on_background of the region from its distance_m.
  void ClassifyByDistance(const Registration& registration, const BackgroundPlanes& background,
                          PixelRegion* region) const;
  /// The same where no surface is predicted: the background alone decides.
  void ClassifyBackground(const Registration& registration, const BackgroundPlanes& background,
                          PixelRegion* region) const;
  /// nullopt where enough pixels of the predicted surface agree with it.
  std::optional<PixelCounts> FindDisagreement(const PredictionView& prediction,
                                              const PixelRegion& region) const;

  /// Compares the colours of pixels that the distance classifies. False: no information. Where the
  /// model is uninitialised, or the light has changed, it is initialised here. Notes are for the
  /// user.
  bool PrepareColors(const RegisteredFrame& frame, const PixelRegion& region,
                     std::vector<std::string>* notes);
  /// Updates the colour model from labelled pixels.
  void UpdateColors(const RegisteredFrame& frame, const PixelRegion& region);
  bool knows_colors() const { return colors_.initialised(); }
  /// While uninitialised: colours of few of these pixels near the robot count as foreign.
  void GuessForeign(const ColorModel::Histogram& near_robot) {
    rare_ = RareColors(near_robot, tuning_.rare);
  }
  std::uint16_t BinOf(const std::uint8_t* rgb) const { return colors_.BinOf(rgb); }
  /// Of a colour that the robot does not have.
  bool IsForeign(std::uint16_t bin) const {
    return colors_.initialised() ? colors_.LogRatio(bin) < tuning_.foreign_log_ratio
                                 : rare_.Hold(bin);
  }
  void ClassifyByColor(const RegisteredFrame& frame, PixelRegion* region) const;

 private:
  struct Sample {
    ColorModel::Histogram robot;
    ColorModel::Histogram background;
    ColorModel::Histogram object;
    double robot_count = 0.0;
  };

  double LeastCount() const;
  /// Colours of everything but the robot.
  ColorModel::Histogram Others() const;
  /// `by_label`: of pixels that are labelled.
  void TakeSample(const RegisteredFrame& frame, const PixelRegion& region, bool by_label);

  ModelConfig config_;
  PixelClassifierTuning tuning_;
  NoiseLaw noise_;
  BackgroundPlanes::Tolerance tolerance_;
  ColorModel colors_;
  RareColors rare_;
  Sample sample_;
};

}  // namespace palpate::perception
