// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <filesystem>

#include "libs/fem/embedding.hpp"
#include "libs/fem/mesh_io/read_mesh.hpp"
#include "libs/fem/mesh_report.hpp"
#include "tests/libs/fem/verification/static_problem.hpp"

namespace palpate::fem::verification {
namespace {

const std::filesystem::path kRobots = std::filesystem::path(PALPATE_SOURCE_DIR) / "config/robots";
const Eigen::Vector3d kGravity_N_m3(0.0, 0.0, -1070.0 * 9.81);

TEST(FourLegMesh, IsFitForUse) {
  const MeshReport report = ReportMesh(ReadMesh(kRobots / "four_leg.msh", 1e-3));
  EXPECT_GE(report.cell_count, 1500);
  EXPECT_LE(report.cell_count, 4000);
  EXPECT_GT(report.worst_quality, 0.15);
  EXPECT_EQ(report.pieces, 1);
  EXPECT_EQ(report.free_edges, 0);
  EXPECT_TRUE(report.inverted_cells.empty());
  EXPECT_TRUE(report.unused_nodes.empty());
  // Euler: a closed surface without handles has V = F / 2 + 2 corners.
  const int surface_nodes = (report.boundary_triangles + 4) / 2;
  EXPECT_GE(report.node_count - surface_nodes, 50) << "interior nodes";
  EXPECT_NEAR(report.max_m[2] - report.min_m[2], 0.125, 1e-6);
  EXPECT_NEAR(report.max_m[0] - report.min_m[0], 0.200, 1e-3);
  EXPECT_LT(std::filesystem::file_size(kRobots / "four_leg.msh"), 1000000u);
}

/// CalculiX (config/robots/check_four_leg.py): 2.72 mm on the same mesh.
TEST(FourLegMesh, SagsUnderItsOwnWeightAsCalculixFound) {
  StaticProblem body(MakeQuadratic(ReadMesh(kRobots / "four_leg.msh", 1e-3)),
                     {.model = MaterialModel::kStableNeoHookean,
                      .youngs_modulus_Pa = 100e3,
                      .poissons_ratio = 0.45});
  body.Fix([](const Eigen::Vector3d& p) { return p[2] < 1e-6; });
  body.AddBodyForce([](const Eigen::Vector3d&) { return kGravity_N_m3; });
  const Solution solution = Solve(body);
  ASSERT_TRUE(solution.result.status.ok()) << solution.result.status.message();
  const Eigen::Vector3d tip_m = solution.Displacement(NearestNode(body.mesh, {0, 0, 0.125}));
  EXPECT_LT((1e3 * tip_m - Eigen::Vector3d(0.0, 0.0, -2.72)).norm(), 0.02)
      << 1e3 * tip_m.transpose();
}

/// tests/data/beam_calculix/truth.yaml, self_weight: another solver, element and mesh.
TEST(BeamMesh, SagsUnderItsOwnWeightAsCalculixFoundWithinOnePercent) {
  StaticProblem beam(MakeQuadratic(ReadMesh(kRobots / "beam.msh", 1.0)),
                     {.model = MaterialModel::kStableNeoHookean,
                      .volumetric = Volumetric::kMeanDilatation,
                      .youngs_modulus_Pa = 231e3,
                      .poissons_ratio = 0.499});
  beam.Fix([](const Eigen::Vector3d& p) { return p[0] < -0.1 + 1e-9; });
  beam.AddBodyForce([](const Eigen::Vector3d&) { return kGravity_N_m3; });
  const Solution solution = Solve(beam);
  ASSERT_TRUE(solution.result.status.ok()) << solution.result.status.message();
  const PointLocator locator(beam.mesh);
  const auto sag_m = [&](const Eigen::Vector3d& marker_m) {
    return marker_m[2] - locator.Embed(marker_m).weights.Position(solution.x_m)[2];
  };
  EXPECT_NEAR(sag_m({0, 0.015, 0.036}) / (0.036 - 0.0281561), 1.0, 0.01);
  EXPECT_NEAR(sag_m({0, -0.006, 0.024}) / (0.024 - 0.0162137), 1.0, 0.01);
  EXPECT_NEAR(sag_m({0, 0.036, 0.006}) / (0.006 + 0.0017060), 1.0, 0.01);
}

}  // namespace
}  // namespace palpate::fem::verification
