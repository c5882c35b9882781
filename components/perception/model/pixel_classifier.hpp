// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "components/perception/config.hpp"
#include "components/perception/model/background_planes.hpp"
#include "components/perception/model/color_model.hpp"
#include "components/perception/model/pixel_region.hpp"
#include "components/perception/model/prediction_view.hpp"
#include "components/perception/model/rare_colors.hpp"
#include "components/perception/noise_law.hpp"
#include "components/perception/registered_frame.hpp"

namespace palpate::perception {

/// How likely each pixel of a region is the robot's: by its distance from the predicted surface,
/// and by its colour, which is estimated where the distance decides.
class PixelClassifier {
 public:
  PixelClassifier(const Config& config, const NoiseLaw& noise);

  /// Sigma of the distance between a measured point of the robot and the fitted surface.
  float Sigma_m(float z_m) const;

  /// Sets evidence and on_background of the region from its distance_m.
  void ClassifyByDistance(const Registration& registration, const BackgroundPlanes& background,
                          PixelRegion* region) const;
  /// The same where no surface is predicted: the background alone decides.
  void ClassifyBackground(const Registration& registration, const BackgroundPlanes& background,
                          PixelRegion* region) const;
  /// kNoRobotSeen where too little of what should be seen of the robot is there.
  Status CheckAgreement(const PredictionView& prediction, const PixelRegion& region) const;

  /// Compares the colours of pixels that the distance classifies. False: no information. Where the
  /// model is uninitialised, or the light has changed, it is initialised here. Notes are for the
  /// user.
  bool PrepareColors(const RegisteredFrame& frame, const PixelRegion& region,
                     std::vector<std::string>* notes);
  /// Updates the colour model from labelled pixels.
  void UpdateColors(const RegisteredFrame& frame, const PixelRegion& region);
  bool knows_colors() const { return colors_.initialised(); }
  /// While uninitialised: colours that few of these pixels near the robot have is taken for
  /// foreign.
  void GuessForeign(const ColorModel::Histogram& near_robot) { rare_ = RareColors(near_robot); }
  std::uint16_t BinOf(const std::uint8_t* rgb) const { return colors_.BinOf(rgb); }
  /// Of a colour that the robot does not have.
  bool IsForeign(std::uint16_t bin) const {
    return colors_.initialised() ? colors_.LogRatio(bin) < kForeign : rare_.Hold(bin);
  }
  void ClassifyByColor(const RegisteredFrame& frame, PixelRegion* region) const;

 private:
  struct Sample {
    ColorModel::Histogram robot;
    ColorModel::Histogram background;
    ColorModel::Histogram object;
    double robot_count = 0.0;
  };

  static constexpr float kForeign = -1.5f;

  double LeastCount() const;
  /// `by_label`: of pixels that are labelled.
  /// Everything but the robot.
  ColorModel::Histogram Others() const;
  void TakeSample(const RegisteredFrame& frame, const PixelRegion& region, bool by_label);

  ModelConfig config_;
  NoiseLaw noise_;
  BackgroundPlanes::Tolerance tolerance_;
  ColorModel colors_;
  RareColors rare_;
  Sample sample_;
};

}  // namespace palpate::perception
