// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/components/virtual_robot/bench_setup.hpp"

#include <unistd.h>

#include <array>
#include <filesystem>
#include <system_error>

#include "libs/fem/mesh_io/write_vtu.hpp"

namespace palpate::virtual_robot::test {

namespace {

/// The six tetrahedra about the diagonal of a brick; corner i has x = i & 1, y = i & 2, z = i & 4.
constexpr std::array<std::array<int, 4>, 6> kSix = {
    {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};

fem::TetMesh Box(const Eigen::Array3i& cells, const Eigen::Vector3d& size_m) {
  const Eigen::Array3i nodes = cells + 1;
  const auto number = [&](int x, int y, int z) { return x + nodes.x() * (y + nodes.y() * z); };
  fem::TetMesh mesh;
  mesh.nodes_m.resize(3, nodes.prod());
  mesh.cells.resize(4, 6 * cells.prod());
  for (int z = 0; z < nodes.z(); ++z) {
    for (int y = 0; y < nodes.y(); ++y) {
      for (int x = 0; x < nodes.x(); ++x) {
        mesh.nodes_m.col(number(x, y, z)) =
            (Eigen::Array3d(x, y, z) * size_m.array() / cells.cast<double>()).matrix();
      }
    }
  }
  int next = 0;
  for (int z = 0; z < cells.z(); ++z) {
    for (int y = 0; y < cells.y(); ++y) {
      for (int x = 0; x < cells.x(); ++x) {
        for (const auto& tet : kSix) {
          for (int k = 0; k < 4; ++k) {
            const int corner = tet[static_cast<size_t>(k)];
            mesh.cells(k, next) =
                number(x + (corner & 1), y + (corner >> 1 & 1), z + (corner >> 2));
          }
          ++next;
        }
      }
    }
  }
  return mesh;
}

/// Mesh files that are taken away when the program ends.
class MeshFiles {
 public:
  ~MeshFiles() {
    std::error_code ignored;
    for (const auto& file : files_) std::filesystem::remove(file, ignored);
  }
  std::filesystem::path New() {
    files_.push_back(std::filesystem::temp_directory_path() /
                     ("palpate_box_" + std::to_string(::getpid()) + "_" +
                      std::to_string(files_.size()) + ".vtu"));
    return files_.back();
  }

 private:
  std::vector<std::filesystem::path> files_;
};

}  // namespace

robot::RobotDescription BoxRobot(const Eigen::Array3i& cells, const Eigen::Vector3d& size_m) {
  static MeshFiles files;
  const fem::TetMesh mesh = Box(cells, size_m);
  robot::RobotDescription robot;
  robot.name = "box";
  robot.mesh.file = files.New();
  fem::WriteVtu(robot.mesh.file, mesh, mesh.nodes_m.reshaped());
  robot.element = fem::ElementType::kTet10;
  robot.material.youngs_modulus_Pa = 1e5;
  robot.material.poissons_ratio = 0.3;
  robot.mass.density_kg_m3 = 1000.0;
  robot.gravity_m_s2.setZero();
  constexpr double kAround_m = 1e-6;
  robot.fixed.push_back(
      {.lower_m = Eigen::Vector3d::Constant(-kAround_m),
       .upper_m = Eigen::Vector3d(kAround_m, size_m.y() + kAround_m, size_m.z() + kAround_m)});
  robot.fixed_where.emplace_back();
  return robot;
}

scenario::Scenario PlainScenario() {
  scenario::Scenario scenario;
  scenario.name = "test";
  scenario.body.refine = 0;
  return scenario;
}

scenario::Scenario DynamicScenario(double time_step_s, double rayleigh_mass_1_s,
                                   double rayleigh_stiffness_s) {
  scenario::Scenario scenario = PlainScenario();
  scenario.motion = {scenario::MotionMode::kDynamic, time_step_s, rayleigh_mass_1_s,
                     rayleigh_stiffness_s};
  return scenario;
}

scenario::ActiveEffect Effect(const std::string& id, const std::vector<std::string>& where,
                              const std::map<std::string, double>& parameters) {
  return {.id = id, .where = where, .parameters = parameters};
}

Inputs NoInputs(int cables) {
  Inputs inputs;
  inputs.displacement_m = Eigen::VectorXd::Constant(cables, kNotDriven);
  return inputs;
}

Inputs Commands(const std::vector<double>& displacement_m) {
  Inputs inputs;
  inputs.displacement_m = Eigen::Map<const Eigen::VectorXd>(
      displacement_m.data(), static_cast<Eigen::Index>(displacement_m.size()));
  return inputs;
}

scenario::HungWeight Weight(const Eigen::Vector3d& position_m, double mass_kg,
                            double patch_radius_m) {
  return {
      .t_s = 0.0, .position_m = position_m, .mass_kg = mass_kg, .patch_radius_m = patch_radius_m};
}

ToolPose At(const std::string& tool, const Eigen::Vector3d& position_m) {
  ToolPose pose{.tool = tool};
  pose.T_robot_tool.translation() = position_m;
  return pose;
}

}  // namespace palpate::virtual_robot::test
