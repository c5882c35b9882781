// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/robots.hpp"

#include <cstdlib>
#include <filesystem>

#include "libs/app/yaml.hpp"

namespace palpate::benchmarks {

namespace {

constexpr const char* kDiamond = R"(
name: diamond
mesh: {file: diamond.vtu, unit: mm, rotate_xyz_deg: [90, 0, 0], translate_mm: [0, 0, 35]}
element: tet4
material: {model: stable_neo_hookean, youngs_modulus_Pa: 180e3, poissons_ratio: 0.45}
mass: {total_kg: 0.5, distribution: per_node}
fixed: [{box_m: [[-0.015, -0.015, -0.040], [0.015, 0.015, 0.010]]}]
cables:
  - {name: north, path_m: [[0, 0.010, 0.030], [0, 0.097, 0.045]], guide_radius_m: 0}
  - {name: west, path_m: [[-0.010, 0, 0.030], [-0.097, 0, 0.045]], guide_radius_m: 0}
  - {name: south, path_m: [[0, -0.010, 0.030], [0, -0.097, 0.045]], guide_radius_m: 0}
  - {name: east, path_m: [[0.010, 0, 0.030], [0.097, 0, 0.045]], guide_radius_m: 0}
)";

std::filesystem::path DataFolder() {
  const char* folder = std::getenv("PALPATE_DATA_DIR");
  return folder != nullptr ? folder : PALPATE_SOURCE_DIR "/../shared/data";
}

}  // namespace

NamedRobot PaperRobot() {
  const std::filesystem::path folder = DataFolder() / "diamond";
  if (!std::filesystem::exists(folder / "diamond.vtu")) {
    NamedRobot robot = OwnRobot("four_leg", fem::ElementType::kTet4);
    robot.name = "stand_in_tet4";
    robot.note = "our robot four_leg, because the paper's mesh is not in " + DataFolder().string();
    return robot;
  }
  return {.name = "diamond_tet4",
          .note = "the paper's mesh, four cables",
          .description =
              robot::ReadRobotFile(folder / "robot.yaml", [](const std::filesystem::path& file) {
                return app::ParseYaml(kDiamond, file.string());
              })};
}

NamedRobot OwnRobot(const std::string& name, fem::ElementType element) {
  const std::filesystem::path file =
      std::filesystem::path(PALPATE_SOURCE_DIR) / "config" / "robots" / (name + ".yaml");
  robot::RobotDescription description = robot::ReadRobotFile(file, app::LoadYaml);
  description.element = element;
  const bool linear = element == fem::ElementType::kTet4;
  if (linear) description.material.volumetric = fem::Volumetric::kPointwise;
  return {.name = name + (linear ? "_tet4" : "_tet10"),
          .note = "config/robots/" + name + ".yaml",
          .description = std::move(description)};
}

}  // namespace palpate::benchmarks
