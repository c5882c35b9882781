// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/rgbd/depth_noise.hpp"

#include <algorithm>
#include <cmath>

namespace palpate::rgbd {

double DepthSigma_m(const RgbdCamera& camera, const DepthNoise& noise, double z_m) {
  const bool stereo = camera.baseline_m > 0.0;
  const double sensor_m =
      stereo ? z_m * z_m * noise.subpixel_px / (camera.depth.fx_px * camera.baseline_m)
             : noise.range_sigma_m;
  constexpr double kStepVariance = 1.0 / 12.0;  // of a uniform error one step wide
  return std::sqrt(sensor_m * sensor_m + kStepVariance * camera.depth_unit_m * camera.depth_unit_m);
}

double IndependentPixels(const DepthNoise& noise, double count) {
  // Area under a Gaussian correlation exp(-r^2 / (2 c^2)).
  constexpr double kTwoPi = 6.283185307179586;
  const double correlated = std::max(1.0, kTwoPi * noise.correlation_px * noise.correlation_px);
  return std::max(1.0, count / correlated);
}

}  // namespace palpate::rgbd
