// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/robots.hpp"

#include <unistd.h>

#include <filesystem>
#include <utility>

#include "libs/fem/mesh_io/read_mesh.hpp"
#include "libs/fem/mesh_io/write_vtu.hpp"
#include "libs/fem/refined_mesh.hpp"
#include "tests/support/robots.hpp"

namespace palpate::benchmarks {

namespace {

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
    for (int k = 0; k < refinements; ++k) mesh = fem::RefineUniformly(mesh);
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
  NamedRobot robot = OwnRobot("four_leg", element);
  if (const auto diamond = test_support::DiamondRobot()) {
    robot.name = "diamond";
    robot.note = "the paper's mesh, four cables";
    robot.description = *diamond;
    robot.description.element = element;
    const bool locks = element == fem::ElementType::kTet4 && refinements == 0;
    if (!locks) {
      robot.description.material.youngs_modulus_Pa = kModulusWithoutLocking_Pa;
      robot.note += ", 450 kPa";
    }
  } else {
    robot.name = "stand_in";
    robot.note = "our robot four_leg, because the paper's mesh is not in " +
                 test_support::MeasuredDataFolder().string();
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
  robot::RobotDescription description = element == fem::ElementType::kTet4
                                            ? test_support::LockingRobot(name)
                                            : test_support::ReadRobot(name);
  description.element = element;
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
