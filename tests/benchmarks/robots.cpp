// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/robots.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <utility>

#include "libs/app/yaml.hpp"
#include "libs/fem/mesh_io/read_mesh.hpp"
#include "libs/fem/mesh_io/write_vtu.hpp"
#include "tests/benchmarks/refine.hpp"

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

robot::RobotDescription Diamond(const std::filesystem::path& folder) {
  return robot::ReadRobotFile(folder / "robot.yaml", [](const std::filesystem::path& file) {
    return app::ParseYaml(kDiamond, file.string());
  });
}

/// The paper's 180 kPa belong to its mesh, which locks and is 2.5 times too stiff; without that the
/// body would buckle under its weight.
constexpr double kModulusWithoutLocking_Pa = 450e3;

/// What the whole suite takes should stay some minutes.
constexpr int kRepetitionsOfMedium = 15;
constexpr int kRepetitionsOfLarge = 5;

std::string ElementName(fem::ElementType element) {
  return element == fem::ElementType::kTet4 ? "tet4" : "tet10";
}

/// A robot's mesh comes from a file: the refined one lies in one for as long as this lives.
class RefinedMeshFile {
 public:
  RefinedMeshFile(const robot::MeshSettings& settings, int refinements)
      : path_(std::filesystem::temp_directory_path() /
              ("palpate-bench-" + std::to_string(getpid()) + ".vtu")) {
    fem::TetMesh mesh = fem::ReadMesh(settings.file, settings.metres_per_unit);
    for (int k = 0; k < refinements; ++k) mesh = RefineUniformly(mesh);
    fem::WriteVtu(path_, mesh, mesh.nodes_m.reshaped());
  }
  ~RefinedMeshFile() {
    std::error_code not_there;
    std::filesystem::remove(path_, not_there);
  }
  RefinedMeshFile(const RefinedMeshFile&) = delete;
  RefinedMeshFile& operator=(const RefinedMeshFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace

NamedRobot PaperRobot(fem::ElementType element, int refinements) {
  const std::filesystem::path folder = DataFolder() / "diamond";
  NamedRobot robot = OwnRobot("four_leg", element);
  if (std::filesystem::exists(folder / "diamond.vtu")) {
    robot.name = "diamond";
    robot.note = "the paper's mesh, four cables";
    robot.description = Diamond(folder);
    robot.description.element = element;
    const bool locks = element == fem::ElementType::kTet4 && refinements == 0;
    if (!locks) {
      robot.description.material.youngs_modulus_Pa = kModulusWithoutLocking_Pa;
      robot.note += ", 450 kPa";
    }
  } else {
    robot.name = "stand_in";
    robot.note = "our robot four_leg, because the paper's mesh is not in " + DataFolder().string();
  }
  if (refinements > 0) {
    const std::string cells = std::to_string(1 << (3 * refinements));
    robot.name.append("_").append(cells).append("x");
    robot.note += ", each cell cut into " + cells;
  }
  robot.name.append("_").append(ElementName(element));
  robot.refinements = refinements;
  robot.large = refinements > 1;
  if (refinements > 0) {
    robot.max_repetitions = robot.large ? kRepetitionsOfLarge : kRepetitionsOfMedium;
  }
  return robot;
}

NamedRobot OwnRobot(const std::string& name, fem::ElementType element) {
  const std::filesystem::path file =
      std::filesystem::path(PALPATE_SOURCE_DIR) / "config" / "robots" / (name + ".yaml");
  robot::RobotDescription description = robot::ReadRobotFile(file, app::LoadYaml);
  description.element = element;
  if (element == fem::ElementType::kTet4) {
    description.material.volumetric = fem::Volumetric::kPointwise;
  }
  NamedRobot robot{.name = name + "_" + ElementName(element),
                   .note = "config/robots/" + name + ".yaml",
                   .description = std::move(description)};
  if (element == fem::ElementType::kTet10) robot.max_repetitions = kRepetitionsOfMedium;
  return robot;
}

robot::RobotBody BuildBody(const NamedRobot& robot) {
  if (robot.refinements == 0) return robot::BuildRobotBody(robot.description);
  const RefinedMeshFile file(robot.description.mesh, robot.refinements);
  robot::RobotDescription refined = robot.description;
  refined.mesh.file = file.path();
  refined.mesh.metres_per_unit = 1.0;
  return robot::BuildRobotBody(refined);
}

}  // namespace palpate::benchmarks
