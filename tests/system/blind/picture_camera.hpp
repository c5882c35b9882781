// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

namespace palpate::blind {

/// Of a scenario: a depth camera half a metre away, of half the resolution that such cameras have,
/// which sees no markers. Its `rate_hz`, which is to follow, may be low: what it shows is no matter
/// of pixels.
inline const std::string kPictureCamera = R"(stage: {marker_radius_m: 0}
camera:
  depth: {width_px: 424, height_px: 240, fx_px: 360, fy_px: 360, cx_px: 211.5, cy_px: 119.5,
          unit_m: 0.0001, baseline_m: 0.05}
  color: {width_px: 424, height_px: 240, fx_px: 360, fy_px: 360, cx_px: 211.5, cy_px: 119.5,
          registered_to_depth: true}
  eye_m: [0.09, -0.09, 0.52]
  target_m: [0, 0, 0.09]
)";

}  // namespace palpate::blind
