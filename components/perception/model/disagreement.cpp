// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/model/disagreement.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "libs/core/statistics.hpp"
#include "libs/core/text.hpp"

namespace palpate::perception {

namespace {

/// No error of a pose brings a robot so near, or so far away.
bool IsOtherUnit(double ratio) {
  constexpr double kSmallest = 0.6, kLargest = 1.7;
  return ratio < kSmallest || ratio > kLargest;
}

std::string OtherUnitText(double ratio) {
  const bool near = ratio < 1.0;
  const double times = near ? 1.0 / ratio : ratio;
  std::array<char, 32> factor{};
  std::snprintf(factor.data(), factor.size(), times < 100.0 ? "%.2g" : "%.0f", times);
  return "its depths are " + std::string(factor.data()) + " times too " + (near ? "near" : "far") +
         " (median of the robot's pixels): is unit_m of camera.yaml " + factor.data() +
         " times too " + (near ? "small" : "large") +
         (near ? ", or does something hide the robot?" : ", or does the camera look past it?");
}

std::string RangeText(const Config& config) {
  return "min_z_m " + FormatNumber(config.min_z_m) + " to max_z_m " + FormatNumber(config.max_z_m);
}

}  // namespace

double MedianDepthRatio(const rgbd::RgbdFrame& frame, const Registration& registration,
                        const PredictionView& prediction) {
  std::vector<double> ratios;
  for (int v = 0; v < frame.depth.height_px; ++v) {
    for (int u = 0; u < frame.depth.width_px; ++u) {
      if (!prediction.Covers(u, v)) continue;
      const float z_m = registration.Depth_m(frame, u, v);
      if (!(z_m > 0.0f)) continue;
      ratios.push_back(static_cast<double>(z_m / prediction.Z_m(u, v)));
    }
  }
  return Median(std::move(ratios));
}

std::string Disagreement(const PixelCounts& pixels, double ratio, const Config& config) {
  const std::string intro = "the depth image does not agree with the predicted robot: ";
  if (std::isnan(ratio)) {
    return intro + "no pixel has a depth where it is predicted: is the camera's pose right?";
  }
  if (IsOtherUnit(ratio)) return intro + OtherUnitText(ratio);
  if (pixels.seen + pixels.hidden == 0) {
    return intro + "all of its depths are out of range, " + RangeText(config);
  }
  if (pixels.seen == 0) {
    return intro + "something nearer hides all of its " + std::to_string(pixels.hidden) + " pixels";
  }
  const int least = config.model.min_robot_pixels;
  const std::string counts = std::to_string(pixels.agree) + " of " + std::to_string(pixels.seen);
  if (pixels.agree >= least) {
    return intro + "only " + counts + " pixels that are not hidden do: is the camera's pose right?";
  }
  if (2 * pixels.agree < pixels.seen) {
    return intro + counts + " pixels that are not hidden do, at least " + std::to_string(least) +
           " must: is the camera's pose right?";
  }
  return "too few pixels show the robot: " + counts +
         " that are not hidden agree with the prediction, at least " + std::to_string(least) +
         " must (min_robot_pixels): bring the camera nearer, or give images of more pixels";
}

std::string NothingInRange(const Rejections& rejected, double ratio, const Config& config) {
  if (rejected.out_of_range == 0) return "no pixel of the depth image has a value";
  const std::string intro =
      "no pixel of the depth image has a value in range, " + RangeText(config) + ": ";
  if (std::isfinite(ratio) && IsOtherUnit(ratio)) return intro + OtherUnitText(ratio);
  return intro + "is the unit of depth right (unit_m of camera.yaml)?";
}

}  // namespace palpate::perception
