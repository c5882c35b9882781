// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

namespace palpate::system_test {

/// Of a scenario: a ball, and a small and slow camera before the robot, for machines that have
/// other things to do.
inline const std::string kBallBeforeASmallCamera =
    R"(motion: {mode: quasi_static, time_step_s: 0.1}
tools: [{name: ball, shape: sphere, radius_m: 0.010, color_rgb: [0.15, 0.30, 0.80]}]
camera:
  depth: {width_px: 424, height_px: 240, fx_px: 212, fy_px: 212, cx_px: 211.5, cy_px: 119.5,
          unit_m: 0.0001, baseline_m: 0.05}
  color: {width_px: 424, height_px: 240, fx_px: 212, fy_px: 212, cx_px: 211.5, cy_px: 119.5,
          registered_to_depth: true}
  eye_m: [0.343, -0.198, 0.275]
  target_m: [0, 0, 0.065]
  rate_hz: 10
  noise: {sensor: stereo}
rest_between_s: 0
)";

}  // namespace palpate::system_test
