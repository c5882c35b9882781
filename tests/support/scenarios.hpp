// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <array>
#include <sstream>
#include <string>

namespace palpate::test_support {

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

/// Of a scenario: that ball presses the four-legged robot from the sixth second on.
inline const std::string kBallThatHolds =
    R"(recordings:
  - name: press
    kind: free
    duration_s: 200
    commands: [{t_s: 0, east.displacement_m: 0}, {t_s: 200, east.displacement_m: 0}]
    tools:
      - tool: ball
        path:
          - {t_s: 4, position_m: [0.0560, -0.0560, 0.103]}
          - {t_s: 5, position_m: [0.0285, -0.0285, 0.103]}
          - {t_s: 6, position_m: [0.0220, -0.0220, 0.103]}
          - {t_s: 200, position_m: [0.0220, -0.0220, 0.103]}
)";

/// Of a scenario: a body of this mesh whose modulus is not the robot file's.
inline std::string BodyOfAnotherModulus(const std::string& mesh_file) {
  return "body: {mesh_file: " + mesh_file +
         ", refine: 0, element: tet10, material: {youngs_modulus_Pa: 96.7e3}}\n";
}

/// Of a scenario: the drive of cable north has a zero of its own.
inline const std::string kOffsetOfNorth =
    "effects: [{id: cable_offset, where: 'cable:north', offset_m: 0.0008}]\n";

/// Displacements of the cables north, west, south and east of the four-legged robot, m.
using FourPulls = std::array<double, 4>;

/// An entry of a recording's `commands`.
inline std::string CommandAt(double t_s, const FourPulls& pulled_m) {
  std::ostringstream text;
  text << "{t_s: " << t_s << ", north.displacement_m: " << pulled_m[0]
       << ", west.displacement_m: " << pulled_m[1] << ", south.displacement_m: " << pulled_m[2]
       << ", east.displacement_m: " << pulled_m[3] << "}";
  return text.str();
}

/// An entry of a scenario's `recordings`: the cables stay where they are.
inline std::string Hold(const std::string& name, double duration_s, const FourPulls& pulled_m) {
  std::ostringstream text;
  text << "  - {name: " << name << ", kind: hold, duration_s: " << duration_s << ", commands: ["
       << CommandAt(0.0, pulled_m) << "]}\n";
  return text.str();
}

}  // namespace palpate::test_support
