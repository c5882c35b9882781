// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "libs/robot/robot_body.hpp"
#include "tests/libs/robot/robot_files.hpp"
#include "tests/support/measured_data.hpp"

namespace palpate::robot {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

std::filesystem::path DiamondFile() {
  return test_support::MeasuredDataFolder() / "diamond" / "diamond.vtu";
}

RobotBody BuildDiamond(const std::string& element) {
  const std::string text = R"(
name: diamond
mesh: {file: diamond.vtu, unit: mm, rotate_xyz_deg: [90, 0, 0], translate_mm: [0, 0, 35]}
material: {model: stable_neo_hookean, youngs_modulus_Pa: 180e3, poissons_ratio: 0.45}
mass: {total_kg: 0.5, distribution: per_node}
fixed: [{box_m: [[-0.015, -0.015, -0.040], [0.015, 0.015, 0.010]]}]
cables:
  - {name: north, path_m: [[0, 0.010, 0.030], [0, 0.097, 0.045]], guide_radius_m: 0}
)";
  return BuildRobotBody(
      ReadText(text + "element: " + element + "\n", DiamondFile().parent_path() / "robot.yaml"));
}

TEST(DiamondBody, HasThePublishedNodesHoldsAndMass) {
  if (!std::filesystem::exists(DiamondFile())) {
    GTEST_SKIP() << "no " << DiamondFile() << " (set PALPATE_DATA_DIR)";
  }
  const RobotBody body = BuildDiamond("tet4");
  EXPECT_EQ(body.mesh.NodeCount(), 1628);
  EXPECT_EQ(body.mesh.CellCount(), 4147);
  EXPECT_EQ(body.fixed.row(0).count(), 58);
  EXPECT_TRUE(body.node_mass_kg.isApproxToConstant(0.5 / 1628.0, 1e-14));
  EXPECT_EQ(body.feature_points.size(), 51U);
  EXPECT_THAT(body.notes, Contains(AllOf(HasSubstr("cable north: attachment 0."),
                                         HasSubstr("mm outside the mesh"))));
}

TEST(DiamondBody, AsTet10HasTheSameCablePathAndBody) {
  if (!std::filesystem::exists(DiamondFile())) {
    GTEST_SKIP() << "no " << DiamondFile() << " (set PALPATE_DATA_DIR)";
  }
  const RobotBody body = BuildDiamond("tet10");
  EXPECT_EQ(body.mesh.CellCount(), 4147);
  const Eigen::VectorXd rest = body.mesh.nodes_m.reshaped();
  const Eigen::Vector3d attachment(0.0, 0.097, 0.045);
  EXPECT_LT((body.cables[0].eyelets[0].weights.Position(rest) - attachment).norm(), 1e-14);
  EXPECT_GT(body.fixed.row(0).count(), 58);
}

}  // namespace
}  // namespace palpate::robot
