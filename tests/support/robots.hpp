// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <tuple>

#include "libs/app/yaml.hpp"
#include "libs/fem/linearisation.hpp"
#include "libs/fem/shape_functions.hpp"
#include "libs/robot/robot_body.hpp"
#include "libs/robot/robot_description.hpp"
#include "tests/support/measured_data.hpp"

namespace palpate::test_support {

/// The file of a robot of config/robots.
inline std::filesystem::path RobotFile(const std::string& name) {
  return std::filesystem::path(PALPATE_SOURCE_DIR) / "config/robots" / (name + ".yaml");
}

/// A robot of config/robots as its file describes it.
inline robot::RobotDescription ReadRobot(const std::string& name) {
  return robot::ReadRobotFile(RobotFile(name), app::LoadYaml);
}

/// Of linear elements, otherwise as its file describes it.
inline robot::RobotDescription LinearRobot(const std::string& name) {
  robot::RobotDescription robot = ReadRobot(name);
  robot.element = fem::ElementType::kTet4;
  return robot;
}

/// Of linear elements and more compressible: quick to solve.
inline robot::RobotDescription QuickRobot(const std::string& name) {
  robot::RobotDescription robot = LinearRobot(name);
  robot.material.poissons_ratio = 0.4;
  return robot;
}

/// Of linear elements as the paper's robot has them, which lock.
inline robot::RobotDescription LockingRobot(const std::string& name) {
  robot::RobotDescription robot = LinearRobot(name);
  robot.material.volumetric = fem::Volumetric::kPointwise;
  return robot;
}

/// Four legs, four cables, nine markers.
inline robot::RobotDescription FourLegRobot() { return ReadRobot("four_leg"); }
inline robot::RobotDescription LinearFourLegRobot() { return LinearRobot("four_leg"); }
inline robot::RobotDescription QuickFourLegRobot() { return QuickRobot("four_leg"); }
inline robot::RobotDescription LockingFourLegRobot() { return LockingRobot("four_leg"); }

/// The four-legged robot's body of few cells, which another virtual robot has, too.
inline std::filesystem::path CoarseFourLegMesh() {
  return std::filesystem::path(PALPATE_SOURCE_DIR) / "config/scenarios/four_leg_coarse.msh";
}

/// The paper's robot as it is computed there, of linear elements with 51 feature points; none where
/// its mesh is not among the data.
inline std::optional<robot::RobotDescription> DiamondRobot() {
  const std::filesystem::path folder = MeasuredDataFolder() / "diamond";
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

/// Cells of `body.mesh`, a beam along x: material 0, and 1 (region "far") beyond x = 60 mm. Fixed
/// at x = 0, 500 kg/m3.
inline void MakeTwoMaterialBeam(const fem::Material& near, const fem::Material& far,
                                robot::RobotBody* body) {
  const fem::TetMesh& mesh = body->mesh;
  body->materials = {near, far};
  body->region_names = {"far"};
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    double x_m = 0.0;
    for (int a = 0; a < 4; ++a) x_m += 0.25 * mesh.nodes_m(0, mesh.cells(a, cell));
    body->material_of_cell.push_back(x_m > 0.06 ? 1 : 0);
  }
  body->fixed = fem::FixedDirections::Constant(3, mesh.NodeCount(), false);
  for (int node = 0; node < mesh.NodeCount(); ++node) {
    if (mesh.nodes_m(0, node) < 1e-9) body->fixed.col(node).setConstant(true);
  }
  body->node_mass_kg =
      fem::ConsistentNodalMass_kg(mesh, Eigen::VectorXd::Constant(mesh.CellCount(), 500.0));
}

}  // namespace palpate::test_support
