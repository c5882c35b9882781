// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/rgbd/rgbd_camera.hpp"

namespace palpate::rgbd {

/// Random error of one pixel of a depth image.
struct DepthNoise {
  double subpixel_px = 0.08;    ///< sigma of the disparity; of stereo cameras (baseline_m > 0)
  double range_sigma_m = 1e-3;  ///< sigma of z of all others
  double correlation_px = 1.5;  ///< correlation length of the error, >= 0
};

/// Sigma of z at `z_m`: z^2 s / (f b) of a stereo camera, and the step of the depth value
/// (unit / sqrt 12), m.
double DepthSigma_m(const RgbdCamera& camera, const DepthNoise& noise, double z_m);

/// How many independent pixels `count` neighbours in the image are worth, in [1, count].
double IndependentPixels(const DepthNoise& noise, double count);

}  // namespace palpate::rgbd
