// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/geometry/triangle_surface.hpp"

#include <gtest/gtest.h>

#include "tests/libs/geometry/shapes.hpp"

namespace palpate::geometry {
namespace {

TEST(TriangleSurface, UnitCubeHasItsAreaAndVolume) {
  EXPECT_NEAR(SurfaceArea_m2(UnitCube()), 6.0, 1e-14);
  EXPECT_NEAR(EnclosedVolume_m3(UnitCube()), 1.0, 1e-14);
}

TEST(TriangleSurface, NormalsPointOutward) {
  const TriangleSurface cube = UnitCube();
  const Eigen::Vector3d middle = Eigen::Vector3d::Constant(0.5);
  for (int t = 0; t < cube.TriangleCount(); ++t) {
    EXPECT_NEAR(TriangleNormal(cube, t).norm(), 1.0, 1e-15);
    EXPECT_NEAR(TriangleNormal(cube, t).dot(cube.Corner(t, 0) - middle), 0.5, 1e-15) << t;
  }
}

TEST(TriangleSurface, AreaVectorsOfAClosedSurfaceAddUpToZero) {
  const TriangleSurface sphere = Sphere(0.1, 12, 20);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int t = 0; t < sphere.TriangleCount(); ++t) sum += TriangleAreaVector_m2(sphere, t);
  EXPECT_LT(sum.norm(), 1e-16);
}

TEST(TriangleSurface, VertexNormalsOfASphereAreRadial) {
  const TriangleSurface sphere = Sphere(0.1, 24, 40);
  const Eigen::Matrix3Xd normals = VertexNormals(sphere);
  for (Eigen::Index v = 40; v < 24 * 40; ++v) {
    EXPECT_GT(normals.col(v).dot(sphere.vertices_m.col(v)) / 0.1, 0.99) << v;
  }
}

TEST(TriangleSurface, VertexNormalsWeighTrianglesByArea) {
  TriangleSurface bent{Eigen::Matrix3Xd(3, 4), Eigen::Matrix3Xi(3, 2)};
  bent.vertices_m << 0, 1, 0, 0,  //
      0, 0, 1, 0,                 //
      0, 0, 0, 3;
  bent.triangles << 0, 0,  //
      1, 2,                //
      2, 3;
  const Eigen::Vector3d expected = Eigen::Vector3d(3.0, 0.0, 1.0).normalized();
  EXPECT_TRUE(VertexNormals(bent).col(0).isApprox(expected, 1e-14));
}

TEST(TriangleSurface, ATriangleWithoutAreaHasNoNormal) {
  TriangleSurface flat{Eigen::Matrix3Xd::Zero(3, 3), Eigen::Matrix3Xi(3, 1)};
  flat.triangles << 0, 1, 2;
  EXPECT_EQ(TriangleNormal(flat, 0), Eigen::Vector3d::Zero());
  EXPECT_EQ(VertexNormals(flat).norm(), 0.0);
}

}  // namespace
}  // namespace palpate::geometry
