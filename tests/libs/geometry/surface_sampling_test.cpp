// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/geometry/surface_sampling.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <set>

#include "tests/libs/geometry/shapes.hpp"

namespace palpate::geometry {
namespace {

double SmallestGap(const Eigen::Matrix3Xd& points) {
  double gap = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      gap = std::min(gap, (points.col(i) - points.col(j)).norm());
    }
  }
  return gap;
}

TEST(SampleByArea, GivesEveryFaceOfACubeItsShare) {
  const SurfaceSamples samples = SampleByArea(UnitCube(), 1200);
  std::vector<int> per_triangle(12, 0);
  for (const int triangle : samples.triangles) ++per_triangle[static_cast<size_t>(triangle)];
  for (const int count : per_triangle) EXPECT_EQ(count, 100);
  EXPECT_TRUE(samples.positions_m.rowwise().mean().isApprox(Eigen::Vector3d::Constant(0.5), 0.01));
}

TEST(SampleByArea, LiesOnItsTriangles) {
  const TriangleSurface sphere = Sphere(0.1, 8, 12);
  const SurfaceSamples samples = SampleByArea(sphere, 500);
  for (int i = 0; i < samples.Count(); ++i) {
    const int t = samples.triangles[static_cast<size_t>(i)];
    const Eigen::Vector3d normal = TriangleNormal(sphere, t);
    EXPECT_EQ(samples.normals.col(i), normal);
    EXPECT_NEAR(normal.dot(samples.positions_m.col(i) - sphere.Corner(t, 0)), 0.0, 1e-15);
  }
}

TEST(FarthestPoints, StartsFarFromTheMeanAndFillsTheLargestGap) {
  Eigen::Matrix3Xd line = Eigen::Matrix3Xd::Zero(3, 6);
  line.row(0) << 0.0, 1.0, 2.0, 3.0, 4.0, 10.0;
  EXPECT_EQ(FarthestPoints(line, 4), (std::vector<int>{5, 0, 4, 2}));
}

TEST(SpreadEvenly, NoTwoPointsLieCloseTogether) {
  constexpr int kCount = 51;
  const SurfaceSamples spread = SpreadEvenly(Sphere(0.1, 30, 40), kCount);
  ASSERT_EQ(spread.Count(), kCount);
  const double area_per_point = 4.0 * std::numbers::pi * 0.01 / kCount;
  EXPECT_GT(SmallestGap(spread.positions_m), 0.75 * std::sqrt(area_per_point));
}

TEST(SpreadEvenly, NoPartOfTheSurfaceIsFarFromAllPoints) {
  const TriangleSurface sphere = Sphere(0.1, 30, 40);
  const SurfaceSamples spread = SpreadEvenly(sphere, 51);
  const double gap = SmallestGap(spread.positions_m);
  const SurfaceSamples probes = SampleByArea(sphere, 3000);
  for (const auto& probe : probes.positions_m.colwise()) {
    EXPECT_LT((spread.positions_m.colwise() - probe).colwise().norm().minCoeff(), 1.15 * gap);
  }
}

TEST(SpreadEvenly, IsTheSameEveryTime) {
  const TriangleSurface sphere = Sphere(0.1, 10, 14);
  EXPECT_EQ(SpreadEvenly(sphere, 20).positions_m, SpreadEvenly(sphere, 20).positions_m);
}

}  // namespace
}  // namespace palpate::geometry
