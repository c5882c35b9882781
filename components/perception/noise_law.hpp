// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/rgbd/depth_noise.hpp"

namespace palpate::perception {

/// rgbd::DepthSigma_m as a fast bound for each pixel: slightly larger where the constant part and
/// the one that grows with z squared are equal.
struct NoiseLaw {
  float constant_m = 0.0f;
  float at_1m_m = 0.0f;

  NoiseLaw() = default;
  NoiseLaw(const rgbd::RgbdCamera& camera, const rgbd::DepthNoise& noise)
      : constant_m(static_cast<float>(rgbd::DepthSigma_m(camera, noise, 0.0))),
        at_1m_m(static_cast<float>(rgbd::DepthSigma_m(camera, noise, 1.0)) - constant_m) {}

  float At(float z_m) const { return constant_m + at_1m_m * z_m * z_m; }
};

}  // namespace palpate::perception
