// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "tests/libs/robot/robot_files.hpp"

namespace palpate::robot {
namespace {

void ExpectSameRobot(const RobotDescription& a, const RobotDescription& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(std::filesystem::absolute(a.mesh.file).lexically_normal(),
            std::filesystem::absolute(b.mesh.file).lexically_normal());
  EXPECT_EQ(a.mesh.metres_per_unit, b.mesh.metres_per_unit);
  EXPECT_EQ(a.mesh.rotate_xyz_deg, b.mesh.rotate_xyz_deg);
  EXPECT_EQ(a.mesh.translate_m, b.mesh.translate_m);
  EXPECT_EQ(a.element, b.element);
  EXPECT_EQ(a.material.model, b.material.model);
  EXPECT_EQ(a.material.volumetric, b.material.volumetric);
  EXPECT_EQ(a.material.youngs_modulus_Pa, b.material.youngs_modulus_Pa);
  EXPECT_EQ(a.material.poissons_ratio, b.material.poissons_ratio);
  EXPECT_EQ(a.creep, b.creep);
  EXPECT_EQ(a.softening, b.softening);
  EXPECT_EQ(a.mass.total_kg, b.mass.total_kg);
  EXPECT_EQ(a.mass.density_kg_m3, b.mass.density_kg_m3);
  EXPECT_EQ(a.mass.distribution, b.mass.distribution);
  EXPECT_EQ(a.gravity_m_s2, b.gravity_m_s2);
  EXPECT_EQ(a.feature_point_count, b.feature_point_count);
  EXPECT_EQ(a.feature_points_m, b.feature_points_m);
}

void ExpectSameLists(const RobotDescription& a, const RobotDescription& b) {
  ASSERT_EQ(a.fixed.size(), b.fixed.size());
  for (size_t k = 0; k < a.fixed.size(); ++k) {
    EXPECT_EQ(a.fixed[k].lower_m, b.fixed[k].lower_m);
    EXPECT_EQ(a.fixed[k].upper_m, b.fixed[k].upper_m);
  }
  ASSERT_EQ(a.cables.size(), b.cables.size());
  for (size_t k = 0; k < a.cables.size(); ++k) {
    EXPECT_EQ(a.cables[k].name, b.cables[k].name);
    EXPECT_EQ(a.cables[k].path_m, b.cables[k].path_m);
    EXPECT_EQ(a.cables[k].max_tension_N, b.cables[k].max_tension_N);
    EXPECT_EQ(a.cables[k].guide_radius_m, b.cables[k].guide_radius_m);
    EXPECT_EQ(a.cables[k].friction_coefficient, b.cables[k].friction_coefficient);
    EXPECT_EQ(a.cables[k].play_m, b.cables[k].play_m);
  }
  ASSERT_EQ(a.fibres.size(), b.fibres.size());
  for (size_t k = 0; k < a.fibres.size(); ++k) {
    EXPECT_EQ(a.fibres[k].name, b.fibres[k].name);
    EXPECT_EQ(a.fibres[k].path_m, b.fibres[k].path_m);
    EXPECT_EQ(a.fibres[k].axial_stiffness_N, b.fibres[k].axial_stiffness_N);
    ASSERT_EQ(a.fibres[k].winding.has_value(), b.fibres[k].winding.has_value());
    if (!a.fibres[k].winding) continue;
    EXPECT_EQ(a.fibres[k].winding->kind, b.fibres[k].winding->kind);
    EXPECT_EQ(a.fibres[k].winding->axis_m, b.fibres[k].winding->axis_m);
    EXPECT_EQ(a.fibres[k].winding->radius_m, b.fibres[k].winding->radius_m);
    EXPECT_EQ(a.fibres[k].winding->spacing_m, b.fibres[k].winding->spacing_m);
    EXPECT_EQ(a.fibres[k].winding->left_handed, b.fibres[k].winding->left_handed);
  }
  ASSERT_EQ(a.regions.size(), b.regions.size());
  for (size_t k = 0; k < a.regions.size(); ++k) {
    EXPECT_EQ(a.regions[k].name, b.regions[k].name);
    EXPECT_EQ(a.regions[k].box.lower_m, b.regions[k].box.lower_m);
    EXPECT_EQ(a.regions[k].box.upper_m, b.regions[k].box.upper_m);
    EXPECT_EQ(a.regions[k].youngs_modulus_Pa, b.regions[k].youngs_modulus_Pa);
    EXPECT_EQ(a.regions[k].mesh_group, b.regions[k].mesh_group);
  }
  ASSERT_EQ(a.markers.size(), b.markers.size());
  for (size_t k = 0; k < a.markers.size(); ++k) {
    EXPECT_EQ(a.markers[k].name, b.markers[k].name);
    EXPECT_EQ(a.markers[k].position_m, b.markers[k].position_m);
  }
}

TEST(WriteRobotFile, WhatIsReadBackIsTheSame) {
  const std::string texts[] = {
      FullRobotText(),
      Changed("total_kg: 0.5, distribution: volume",
              "density_kg_m3: 1070.1, distribution: per_node"),
      Changed("element: tet10", "element: tet4"),
      Changed("poissons_ratio: 0.45", "poissons_ratio: 0.499, volumetric: pointwise"),
      Changed("poissons_ratio: 0.45",
              "poissons_ratio: 0.45, creep: [{share: 0.15, time_s: 5}, {share: 1, time_s: 60}], "
              "softening: {r: 2.5, m_J_m3: 300}"),
      Changed("max_tension_N: 20", "max_tension_N: 20, play_m: 0.0012"),
      Changed(
          "regions:\n",
          "fibres:\n"
          "  - {name: line, path_m: [[0, 0.01, 0], [0, 0.09, 0]], axial_stiffness_N: 500}\n"
          "  - {name: a, helix: {axis_m: [[0, 0, 0], [0, 0.1, 0]], radius_m: 0.007, turns: 7}}\n"
          "  - {name: b, helix: {axis_m: [[0, 0, 0], [0, 0.1, 0]], radius_m: 0.007,\n"
          "      pitch_m: 0.011, hand: left}}\n"
          "  - {name: c, rings: {axis_m: [[0, 0, 0], [0, 0.1, 0]], radius_m: 0.007,\n"
          "      count: 4}, axial_stiffness_N: 20}\n"
          "  - {name: d, rings: {axis_m: [[0, 0, 0], [0, 0.1, 0]], radius_m: 0.007,\n"
          "      spacing_m: 0.01}}\n"
          "regions:\n"),
      Changed("name: test beam", "name: 'a \\ back'"),
      Changed("box_m: [[-0.02, 0, -0.02], [0.02, 0.02, 0.02]]", "mesh_group: 'soft body: 1'"),
      Changed("{count: 12}", "[[0, 0.1, 0], [0.1e-7, 0.05, 0.0123456789]]")};
  for (const std::string& text : texts) {
    const RobotDescription robot = ReadText(text, "here/robot.yaml");
    const RobotDescription again = ReadText(FormatRobotFile(robot, "there"), "there/robot.yaml");
    ExpectSameRobot(robot, again);
    ExpectSameLists(robot, again);
  }
}

TEST(WriteRobotFile, NamesTheMeshRelativeToItself) {
  const RobotDescription robot = ReadText(FullRobotText(), "results/here/robot.yaml");
  EXPECT_NE(FormatRobotFile(robot, "results/there").find("file: \"../here/beam.vtk\""),
            std::string::npos);
}

TEST(WriteRobotFile, WritesAFileThatLoads) {
  const TestFolder folder;
  const RobotDescription robot = ReadText(FullRobotText(), folder / "robot.yaml");
  WriteRobotFile(robot, folder / "written.yaml");
  const RobotDescription again = ReadRobotFile(folder / "written.yaml", app::LoadYaml);
  ExpectSameRobot(robot, again);
  ExpectSameLists(robot, again);
}

TEST(WriteRobotFile, SaysSoWhereItCannotWrite) {
  const TestFolder folder;
  const RobotDescription robot = ReadText(FullRobotText(), folder / "robot.yaml");
  EXPECT_THROW(WriteRobotFile(robot, folder / "missing/written.yaml"), RunError);
}

}  // namespace
}  // namespace palpate::robot
