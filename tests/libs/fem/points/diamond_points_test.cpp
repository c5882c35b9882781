// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "libs/fem/embedding.hpp"
#include "libs/fem/mesh_io/read_mesh.hpp"
#include "libs/geometry/rigid_transform.hpp"
#include "tests/support/measured_data.hpp"

namespace palpate::fem {
namespace {

std::filesystem::path DiamondFile() {
  return test_support::MeasuredDataFolder() / "diamond" / "diamond.vtu";
}

/// As the measured data's README places it: +90 degrees about x, then 35 mm up.
TetMesh PlacedDiamond() {
  TetMesh mesh = ReadMesh(DiamondFile(), 1e-3);
  const Eigen::Matrix3d R = geometry::RotationFromFixedXyz_deg({90.0, 0.0, 0.0});
  mesh.nodes_m = ((R * mesh.nodes_m).colwise() + Eigen::Vector3d(0.0, 0.0, 0.035)).eval();
  return mesh;
}

struct Attachment {
  std::string cable;
  Eigen::Vector3d point_m;
  std::array<int, 4> nodes;
  std::array<double, 4> weights;
};

const std::array<Attachment, 4> kAttachments{{
    {"north",
     {0.0, 0.097, 0.045},
     {444, 483, 1237, 1445},
     {0.052767871, 0.707253774, 0.410298299, -0.170319945}},
    {"west",
     {-0.097, 0.0, 0.045},
     {189, 386, 527, 729},
     {0.330496411, -0.045823406, 0.034597763, 0.680729233}},
    {"south",
     {0.0, -0.097, 0.045},
     {338, 339, 726, 1380},
     {-0.022738129, 0.096097133, 0.635391274, 0.291249722}},
    {"east",
     {0.097, 0.0, 0.045},
     {139, 430, 603, 671},
     {0.572610837, 0.310111369, 0.154220866, -0.036943071}},
}};

TEST(Diamond, CableAttachmentsHaveThePublishedNodesAndWeights) {
  if (!std::filesystem::exists(DiamondFile())) {
    GTEST_SKIP() << "no " << DiamondFile() << " (set PALPATE_DATA_DIR)";
  }
  const PointLocator locator(PlacedDiamond());
  for (const Attachment& expected : kAttachments) {
    const BodyPoint point = locator.Embed(expected.point_m);
    ASSERT_EQ(point.weights.nodes.size(), 4U);
    for (size_t k = 0; k < 4; ++k) {
      EXPECT_EQ(point.weights.nodes[k], expected.nodes[k]) << expected.cable;
      EXPECT_NEAR(point.weights.weights[k], expected.weights[k], 1e-8) << expected.cable;
    }
    EXPECT_GT(point.distance_m, 0.0) << expected.cable;
    EXPECT_LT(point.distance_m, 0.95e-3) << expected.cable;
  }
}

TEST(Diamond, EyeletsAtTheAttachmentsHaveModerateWeights) {
  if (!std::filesystem::exists(DiamondFile())) {
    GTEST_SKIP() << "no " << DiamondFile() << " (set PALPATE_DATA_DIR)";
  }
  const PointLocator locator(PlacedDiamond());
  for (const Attachment& attachment : kAttachments) {
    for (const double weight : locator.EmbedBall(attachment.point_m, 1.5e-3).weights.weights) {
      EXPECT_LT(std::abs(weight), 2.0) << attachment.cable;
    }
  }
}

}  // namespace
}  // namespace palpate::fem
