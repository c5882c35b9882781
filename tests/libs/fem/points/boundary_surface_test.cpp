// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/boundary_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/libs/fem/points/meshes.hpp"

namespace palpate::fem {
namespace {

const Eigen::Vector3d kSize_m(0.10, 0.02, 0.03);

TEST(ExtractBoundary, ClosesABoxOfKnownAreaAndVolume) {
  const TetMesh mesh = BoxMesh(kSize_m, {5, 2, 3});
  const BoundarySurface boundary = ExtractBoundary(mesh);
  EXPECT_EQ(boundary.FaceCount(), 2 * 2 * (5 * 2 + 2 * 3 + 5 * 3));
  const geometry::TriangleSurface surface = RestSurface(mesh, boundary);
  EXPECT_NEAR(geometry::EnclosedVolume_m3(surface), kSize_m.prod(), 1e-18);
  EXPECT_NEAR(geometry::SurfaceArea_m2(surface), 2.0 * (0.10 * 0.02 + 0.02 * 0.03 + 0.10 * 0.03),
              1e-16);
}

TEST(ExtractBoundary, ASingleCellShowsAllItsFacesOutward) {
  TetMesh cell{Eigen::Matrix3Xd::Zero(3, 4), Eigen::MatrixXi(4, 1), {}};
  cell.nodes_m.rightCols<3>().setIdentity();
  cell.cells << 0, 1, 2, 3;
  for (const TetMesh& mesh : {cell, MakeQuadratic(cell)}) {
    const BoundarySurface boundary = ExtractBoundary(mesh);
    const geometry::TriangleSurface drawn{mesh.nodes_m, boundary.DrawnTriangles()};
    const Eigen::Vector3d middle = Eigen::Vector3d::Constant(0.25);
    EXPECT_EQ(boundary.FaceCount(), 4);
    EXPECT_NEAR(geometry::EnclosedVolume_m3(drawn), 1.0 / 6.0, 1e-15);
    for (int t = 0; t < drawn.TriangleCount(); ++t) {
      EXPECT_GT(geometry::TriangleNormal(drawn, t).dot(drawn.Corner(t, 0) - middle), 0.1) << t;
    }
  }
}

TEST(ExtractBoundary, FacesBelongToTheirCells) {
  const TetMesh mesh = MakeQuadratic(BoxMesh(kSize_m, {3, 2, 2}));
  const BoundarySurface boundary = ExtractBoundary(mesh);
  for (int f = 0; f < boundary.FaceCount(); ++f) {
    const auto cell = mesh.cells.col(boundary.cells(f));
    for (const int node : boundary.faces.col(f)) {
      EXPECT_NE(std::find(cell.begin(), cell.end(), node), cell.end()) << f;
    }
  }
}

TEST(ExtractBoundary, QuadraticFacesNameTheirMidEdgesInOrder) {
  const TetMesh mesh = MakeQuadratic(BoxMesh(kSize_m, {2, 2, 2}));
  const BoundarySurface boundary = ExtractBoundary(mesh);
  ASSERT_EQ(boundary.faces.rows(), 6);
  for (int f = 0; f < boundary.FaceCount(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d middle = 0.5 * (mesh.nodes_m.col(boundary.faces(k, f)) +
                                            mesh.nodes_m.col(boundary.faces((k + 1) % 3, f)));
      EXPECT_LT((mesh.nodes_m.col(boundary.faces(3 + k, f)) - middle).norm(), 1e-16);
    }
  }
}

TEST(BoundarySurface, DrawnTrianglesOfTet10EncloseTheSameBody) {
  const TetMesh mesh = MakeQuadratic(BoxMesh(kSize_m, {2, 2, 2}));
  const BoundarySurface boundary = ExtractBoundary(mesh);
  const geometry::TriangleSurface drawn{mesh.nodes_m, boundary.DrawnTriangles()};
  EXPECT_EQ(drawn.TriangleCount(), 4 * boundary.FaceCount());
  EXPECT_NEAR(geometry::EnclosedVolume_m3(drawn), kSize_m.prod(), 1e-18);
  EXPECT_NEAR(geometry::SurfaceArea_m2(drawn),
              geometry::SurfaceArea_m2(RestSurface(mesh, boundary)), 1e-16);
}

}  // namespace
}  // namespace palpate::fem
