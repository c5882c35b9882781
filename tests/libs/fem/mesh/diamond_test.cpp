// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <filesystem>

#include "libs/fem/mesh_io/read_mesh.hpp"
#include "libs/fem/mesh_report.hpp"
#include "tests/support/measured_data.hpp"

namespace palpate::fem {
namespace {

TEST(Diamond, IsReadAsItsPageSays) {
  const auto file = test_support::MeasuredDataFolder() / "diamond" / "diamond.vtu";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
  const TetMesh mesh = ReadMesh(file, 1e-3);
  const MeshReport report = ReportMesh(mesh);
  EXPECT_EQ(report.node_count, 1628);
  EXPECT_EQ(report.cell_count, 4147);
  EXPECT_NEAR(report.volume_m3 * 1e9, 392357.0, 0.5);
  EXPECT_NEAR(report.worst_quality, 0.025, 0.0005);
  EXPECT_EQ(report.pieces, 1);
  EXPECT_EQ(report.free_edges, 0);
  EXPECT_TRUE(report.unused_nodes.empty());
  EXPECT_NO_THROW(CheckSolvable(mesh, report, file.string()));
  EXPECT_NEAR(ReportMesh(MakeQuadratic(mesh)).volume_m3, report.volume_m3, 1e-15);
}

}  // namespace
}  // namespace palpate::fem
