// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/model/pixel_classifier.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace palpate::perception {

namespace {

constexpr float kRootTwoPi = 2.5066283f;

std::size_t FirstPixel(const RegisteredFrame& frame, const PixelRegion& region, int row) {
  return static_cast<std::size_t>(region.v_begin + row) *
             static_cast<std::size_t>(frame.z_m.width_px) +
         static_cast<std::size_t>(region.u_begin);
}

}  // namespace

PixelClassifier::PixelClassifier(const Config& config, const NoiseLaw& noise,
                                 const PixelClassifierTuning& tuning)
    : config_(config.model),
      tuning_(tuning),
      noise_(noise),
      tolerance_{.noise = noise, .bias = static_cast<float>(config.model.background_bias)},
      colors_(tuning.colors) {
  if (const auto rgb = RobotColor(config)) colors_.Assume({rgb->x(), rgb->y(), rgb->z()});
}

float PixelClassifier::Sigma_m(float z_m) const {
  const auto surface_m = static_cast<float>(config_.surface_sigma_m);
  const float depth_m = noise_.At(z_m);
  return std::sqrt(surface_m * surface_m + depth_m * depth_m);
}

void PixelClassifier::ClassifyByDistance(const Registration& registration,
                                         const BackgroundPlanes& background,
                                         PixelRegion* region) const {
  ClassifyBackground(registration, background, region);
  for (std::size_t at = 0; at < region->size(); ++at) {
    const float z_m = region->z_m[at];
    if (z_m <= 0.0f) continue;
    const float distance_m = region->distance_m[at];
    const float sigma_m = Sigma_m(z_m);
    const float off = distance_m / (distance_m < 0.0f ? tuning_.inside_sigmas * sigma_m : sigma_m);
    const float against = 0.5f * off * off;
    const float evidence = against > -tuning_.least_evidence + 5.0f
                               ? tuning_.least_evidence
                               : std::log(tuning_.elsewhere_m / (kRootTwoPi * sigma_m)) - against;
    region->evidence[at] += std::max(tuning_.least_evidence, evidence);
  }
}

void PixelClassifier::ClassifyBackground(const Registration& registration,
                                         const BackgroundPlanes& background,
                                         PixelRegion* region) const {
  for (int row = 0; row < region->height; ++row) {
    for (int column = 0; column < region->width; ++column) {
      const std::size_t at = region->At(column, row);
      const float z_m = region->z_m[at];
      const Eigen::Vector3f ray = registration.Ray(region->u_begin + column, region->v_begin + row);
      const bool held = z_m > 0.0f && background.Holds(z_m * ray, tolerance_);
      region->on_background[at] = held ? 1 : 0;
      region->evidence[at] = held ? tuning_.background_evidence : 0.0f;
    }
  }
}

std::optional<PixelCounts> PixelClassifier::FindDisagreement(const PredictionView& prediction,
                                                             const PixelRegion& region) const {
  PixelCounts pixels;
  const auto largest_m = static_cast<float>(config_.largest_error_m);
  for (int row = 0; row < region.height; ++row) {
    for (int column = 0; column < region.width; ++column) {
      const int u = region.u_begin + column, v = region.v_begin + row;
      const std::size_t at = region.At(column, row);
      const float z_m = region.z_m[at];
      if (z_m <= 0.0f || !prediction.Covers(u, v)) continue;
      const bool agrees = region.evidence[at] > 0.0f;
      const bool hidden = !agrees && z_m < prediction.Z_m(u, v) - largest_m;
      pixels.agree += agrees ? 1 : 0;
      (hidden ? pixels.hidden : pixels.seen) += 1;
    }
  }
  const bool enough = pixels.agree >= config_.min_robot_pixels &&
                      static_cast<double>(pixels.agree) >=
                          tuning_.least_agreement * static_cast<double>(pixels.seen);
  return enough ? std::nullopt : std::optional(pixels);
}

void PixelClassifier::TakeSample(const RegisteredFrame& frame, const PixelRegion& region,
                                 bool by_label) {
  sample_.robot.assign(ColorModel::kBins, 0.0f);
  sample_.background.assign(ColorModel::kBins, 0.0f);
  sample_.object.assign(ColorModel::kBins, 0.0f);
  sample_.robot_count = 0.0;
  const float far_m = tuning_.far_share * static_cast<float>(config_.largest_error_m);
  for (int row = 0; row < region.height; row += tuning_.sample_step_px) {
    const std::size_t first = FirstPixel(frame, region, row);
    for (int column = 0; column < region.width; column += tuning_.sample_step_px) {
      const std::size_t at = region.At(column, row);
      const std::size_t pixel = first + static_cast<std::size_t>(column);
      if (region.z_m[at] <= 0.0f || frame.color_known[pixel] == 0) continue;
      const std::uint16_t bin = colors_.BinOf(frame.color.values.data() + 3 * pixel);
      const float distance_m = std::abs(region.distance_m[at]);
      const Label label = region.label[at];
      if (region.on_background[at] != 0) {
        if (distance_m > far_m) sample_.background[bin] += 1.0f;
      } else if (distance_m > far_m || label == Label::kObject) {
        sample_.object[bin] += 1.0f;
      } else if ((!by_label || label == Label::kRobot) &&
                 distance_m < tuning_.sure_sigmas * Sigma_m(region.z_m[at])) {
        sample_.robot[bin] += 1.0f;
        sample_.robot_count += 1.0;
      }
    }
  }
}

bool PixelClassifier::PrepareColors(const RegisteredFrame& frame, const PixelRegion& region,
                                    std::vector<std::string>* notes) {
  TakeSample(frame, region, false);
  if (sample_.robot_count < LeastCount()) return colors_.initialised();
  const auto without_color = static_cast<double>(sample_.robot[ColorModel::kNoColor]);
  if (without_color > tuning_.most_without_color * sample_.robot_count) {
    notes->emplace_back("the robot's colour is saturated or dark: the shape alone is used");
    return false;
  }
  if (colors_.initialised() && colors_.Similarity(sample_.robot) < tuning_.least_similarity) {
    notes->emplace_back("the light has changed: colour model re-initialised");
    colors_.Forget();
  }
  if (!colors_.initialised()) colors_.Update(sample_.robot, Others(), 1.0);
  return true;
}

void PixelClassifier::UpdateColors(const RegisteredFrame& frame, const PixelRegion& region) {
  TakeSample(frame, region, true);
  if (sample_.robot_count >= LeastCount()) {
    colors_.Update(sample_.robot, Others(), config_.color_update);
  }
}

/// Normalised, so that objects count whatever their number of pixels: a pixel off the background is
/// robot or object.
ColorModel::Histogram PixelClassifier::Others() const {
  const auto sum = [](const ColorModel::Histogram& counts) {
    return std::accumulate(counts.begin(), counts.end(), 0.0f);
  };
  const float background = sum(sample_.background);
  const float object = sum(sample_.object);
  ColorModel::Histogram others(ColorModel::kBins, 0.0f);
  for (std::size_t i = 0; i < others.size(); ++i) {
    others[i] = sample_.background[i] / std::max(1.0f, background) +
                tuning_.object_share * sample_.object[i] / (object + tuning_.few_objects_px);
  }
  return others;
}

double PixelClassifier::LeastCount() const {
  return static_cast<double>(config_.min_robot_pixels) /
         (tuning_.sample_step_px * tuning_.sample_step_px);
}

void PixelClassifier::ClassifyByColor(const RegisteredFrame& frame, PixelRegion* region) const {
  for (int row = 0; row < region->height; ++row) {
    const std::size_t first = FirstPixel(frame, *region, row);
    float* evidence = region->evidence.data() + region->At(0, row);
    for (int column = 0; column < region->width; ++column) {
      const std::size_t pixel = first + static_cast<std::size_t>(column);
      if (frame.color_known[pixel] == 0) continue;
      evidence[column] += colors_.LogRatio(colors_.BinOf(frame.color.values.data() + 3 * pixel));
    }
  }
}

}  // namespace palpate::perception
