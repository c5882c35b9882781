// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gmock/gmock.h>

#include <string>

#include "libs/app/yaml.hpp"
#include "libs/scenario/scenario.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::scenario {

/// A scenario that uses every section. One line for each thing, so that tests can replace one.
inline const std::string kFullScenario = R"(name: full
body:
  refine: 2
  element: tet4
  material: {model: yeoh, youngs_modulus_Pa: 91.0e3, poissons_ratio: 0.47, c20_over_c10: 0.2, c30_over_c10: 0.01}
  prony: [{g: 0.1, tau_s: 5}, {g: 0.05, tau_s: 50}]
motion: {mode: dynamic, time_step_s: 0.005, rayleigh_mass_1_s: 2, rayleigh_stiffness_s: 0.002}
effects:
  - {id: cable_friction, where: cable:north, mu: 0.3}
  - {id: swapped_cables, where: [cable:east, cable:west]}
  - {id: cable_offset, offset_m: [0.001, 0.004]}
  - {id: camera_moved, translation_m: 0.01, from_recording: 1}
clutter: 0.5
tools:
  - {name: ball, shape: sphere, radius_m: 0.012, friction_coefficient: 0.4, color_rgb: [0.1, 0.2, 0.3]}
  - {name: rod, shape: cylinder, radius_m: 0.005, length_m: 0.08}
  - {name: board, shape: plate, size_m: [0.1, 0.08, 0.004]}
  - {name: visitor, shape: hand}
camera:
  depth: {width_px: 848, height_px: 480, fx_px: 425, fy_px: 425, cx_px: 423.5, cy_px: 239.5, unit_m: 0.0001, baseline_m: 0.05}
  T_robot_camera: {translation_m: [0.1, -0.4, 0.2], rotation_xyzw: [1, 0, 0, 0]}
  rate_hz: 15
  noise: {sensor: time_of_flight, subpixel_px: 0.1, correlation_px: 2, temporal_correlation: 0.4, disparity_step_px: 0.125, periodic_bias_px: 0.02, low_frequency_bias: 0.001, edge_hole_ratio: 0.4, flying_pixel_ratio: 0.2, grazing_angle_rad: 1.1, range_sigma_m: 0.003}
stage: {table_height_m: -0.01, table_size_m: [0.5, 0.6], table_color_rgb: [0.1, 0.1, 0.1], background_distance_m: 0.7, background_color_rgb: [0.2, 0.2, 0.2], robot_color_rgb: [0.3, 0.3, 0.3], marker_radius_m: 0.003, marker_color_rgb: [0.1, 0.7, 0.2], light: 0.8}
markers: {sigma_m: [0.0001, 0.0002, 0.0003], rate_hz: 60}
rest_between_s: 2.5
recordings:
  - name: a_ramp
    kind: ramp
    duration_s: 4
    commands:
      - {t_s: 0, north.displacement_m: 0, east.displacement_m: ~}
      - {t_s: 2, north.displacement_m: 0.01, east.displacement_m: 0.002}
    weights:
      - {t_s: 1, position_m: [0, 0, 0.12], mass_kg: 0.05, patch_radius_m: 0.01}
      - {t_s: 1, position_m: [0.05, 0, 0.09], mass_kg: 0.02}
      - {t_s: 3, position_m: [0, 0, 0.12], mass_kg: 0}
    notes: "up and hold"
  - name: b_push
    duration_s: 3.5
    tools:
      - tool: ball
        path:
          - {t_s: 0, position_m: [0, 0, 0.2]}
          - {t_s: 2, position_m: [0, 0, 0.1], rotation_xyz_deg: [0, 0, 90]}
    base_tilt_deg: [5, -10]
    eye_m: [0.45, 0, 0.1]
    target_m: [0, 0, 0.1]
)";

/// kFullScenario with one piece of text replaced.
inline std::string FullWith(const std::string& old, const std::string& fresh) {
  std::string text = kFullScenario;
  const std::size_t place = text.find(old);
  EXPECT_NE(place, std::string::npos) << old;
  return text.replace(place, old.size(), fresh);
}

inline Scenario Parse(const std::string& text) {
  return ReadScenario("bench/s.yaml", [&](const std::filesystem::path& file) {
    return app::ParseYaml(text, file.string());
  });
}

inline std::string RefusalOf(const std::string& text) {
  return test_support::MessageOf([&] { Parse(text); });
}

inline std::string RefusalWith(const std::string& old, const std::string& fresh) {
  return RefusalOf(FullWith(old, fresh));
}

}  // namespace palpate::scenario
