// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <tuple>

#include "libs/app/yaml.hpp"
#include "libs/robot/robot_description.hpp"

namespace palpate::test_support {

/// Measured data: PALPATE_DATA_DIR, else ../shared/data beside the sources.
inline std::filesystem::path DataFolder() {
  const char* folder = std::getenv("PALPATE_DATA_DIR");
  return folder != nullptr ? folder : PALPATE_SOURCE_DIR "/../shared/data";
}

/// The paper's robot as it is computed there, of linear elements with 51 feature points; none where
/// its mesh is not among the data.
inline std::optional<robot::RobotDescription> DiamondRobot() {
  const std::filesystem::path folder = DataFolder() / "diamond";
  if (!std::filesystem::exists(folder / "diamond.vtu")) return std::nullopt;
  constexpr const char* kText = R"(
name: diamond
mesh: {file: diamond.vtu, unit: mm, rotate_xyz_deg: [90, 0, 0], translate_mm: [0, 0, 35]}
element: tet4
material: {model: stable_neo_hookean, youngs_modulus_Pa: 180e3, poissons_ratio: 0.45}
mass: {total_kg: 0.5, distribution: per_node}
fixed: [{box_m: [[-0.015, -0.015, -0.040], [0.015, 0.015, 0.010]]}]
feature_points: {count: 51}
cables:
  - {name: north, path_m: [[0, 0.010, 0.030], [0, 0.097, 0.045]], guide_radius_m: 0}
  - {name: west, path_m: [[-0.010, 0, 0.030], [-0.097, 0, 0.045]], guide_radius_m: 0}
  - {name: south, path_m: [[0, -0.010, 0.030], [0, -0.097, 0.045]], guide_radius_m: 0}
  - {name: east, path_m: [[0.010, 0, 0.030], [0.097, 0, 0.045]], guide_radius_m: 0}
)";
  return robot::ReadRobotFile(folder / "robot.yaml", [](const std::filesystem::path& file) {
    return app::ParseYaml(kText, file.string());
  });
}

/// The paper's robot with markers on the tip, the upper legs and the knees; none where its mesh is
/// not among the data.
inline std::optional<robot::RobotDescription> DiamondWithMarkers() {
  std::optional<robot::RobotDescription> robot = DiamondRobot();
  if (!robot) return robot;
  const auto add = [&](const std::string& name, double x_m, double y_m, double z_m) {
    robot->markers.push_back({name, {x_m, y_m, z_m}, {}});
  };
  add("tip", 0.0, 0.0, 0.1255);
  for (const auto& [name, away_m, z_m] :
       {std::tuple("leg", 0.049, 0.091), std::tuple("knee", 0.097, 0.0466)}) {
    add(std::string(name) + "_north", 0.0, away_m, z_m);
    add(std::string(name) + "_west", -away_m, 0.0, z_m);
    add(std::string(name) + "_south", 0.0, -away_m, z_m);
    add(std::string(name) + "_east", away_m, 0.0, z_m);
  }
  return robot;
}

}  // namespace palpate::test_support
