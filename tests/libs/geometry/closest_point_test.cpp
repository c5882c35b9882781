// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/geometry/closest_point.hpp"
#include "libs/geometry/ray.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "tests/libs/geometry/shapes.hpp"

namespace palpate::geometry {
namespace {

Eigen::Matrix3Xd RandomPoints(int count, double half_width_m, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(-half_width_m, half_width_m);
  return Eigen::Matrix3Xd::NullaryExpr(3, count, [&] { return value(random); });
}

/// Independent of the closed form: a fine grid of barycentric coordinates.
double GridDistance(const Eigen::Matrix3d& corners, const Eigen::Vector3d& point, int steps) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; j <= steps - i; ++j) {
      const Eigen::Vector3d weights(i, j, steps - i - j);
      nearest = std::min(nearest, (corners * weights / steps - point).norm());
    }
  }
  return nearest;
}

TEST(ClosestPointOnTriangle, IsNoFartherThanAnyPointOfAFineGrid) {
  const Eigen::Matrix3Xd random = RandomPoints(400, 1.0, 3);
  for (Eigen::Index k = 0; k + 3 < random.cols(); k += 4) {
    const Eigen::Matrix3d corners = random.middleCols<3>(k);
    const Eigen::Vector3d point = random.col(k + 3);
    const Eigen::Vector3d weights =
        ClosestPointOnTriangle(corners.col(0), corners.col(1), corners.col(2), point);
    EXPECT_GE(weights.minCoeff(), 0.0);
    EXPECT_NEAR(weights.sum(), 1.0, 1e-14);
    const double grid_distance = GridDistance(corners, point, 60);
    const double distance = (corners * weights - point).norm();
    EXPECT_LE(distance, grid_distance + 1e-14);
    EXPECT_GE(distance, grid_distance - 0.06);
  }
}

TEST(ClosestPointOnTriangle, TreatsATriangleWithoutAreaAsItsEdges) {
  const Eigen::Vector3d a(0, 0, 0), b(1, 0, 0), c(2, 0, 0);
  const Eigen::Vector3d weights = ClosestPointOnTriangle(a, b, c, {1.5, 1.0, 0.0});
  EXPECT_TRUE((weights(0) * a + weights(1) * b + weights(2) * c)
                  .isApprox(Eigen::Vector3d(1.5, 0, 0), 1e-14));
}

TEST(FirstOnRay, IsTheNearerWallOfTwo) {
  const TriangleSurface cube = UnitCube();
  const Eigen::Vector3d origin_m(-1.0, 0.4, 0.3), direction(2.0, 0.1, 0.1);
  const auto hit = FirstOnRay(cube, origin_m, direction);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->position_m.x(), 0.0, 1e-14);
  EXPECT_NEAR(hit->distance_m, (hit->position_m - origin_m).norm(), 1e-14);
  EXPECT_NEAR((hit->position_m - origin_m).cross(direction).norm(), 0.0, 1e-14);
  Eigen::Vector3d by_corners_m = Eigen::Vector3d::Zero();
  for (int corner = 0; corner < 3; ++corner) {
    by_corners_m += hit->barycentric[corner] * cube.Corner(hit->triangle, corner);
  }
  EXPECT_TRUE(by_corners_m.isApprox(hit->position_m, 1e-13));
  EXPECT_FALSE(FirstOnRay(cube, origin_m, -direction));
}

TEST(RayMeets, TheWallsAroundAPointAndNothingBehindIt) {
  const TriangleSurface cube = UnitCube();
  const Eigen::Matrix3Xd directions = RandomPoints(200, 1.0, 9);
  for (const Eigen::Vector3d direction : directions.colwise()) {
    EXPECT_TRUE(RayMeets(cube, {0.3, 0.6, 0.2}, direction));
    // From beside the cube only rays towards it can meet it.
    if (direction.x() > 0.0) {
      EXPECT_FALSE(RayMeets(cube, {1.5, 0.5, 0.5}, direction));
    }
  }
  EXPECT_TRUE(RayMeets(cube, {1.5, 0.5, 0.4}, {-1.0, 0.0, 0.0}));
  EXPECT_FALSE(RayMeets(cube, {1.5, 2.5, 0.4}, {-1.0, 0.0, 0.0}));
}

TEST(SurfaceIndex, FindsWhatASearchThroughAllTrianglesFinds) {
  const TriangleSurface sphere = Sphere(0.1, 20, 30);
  const SurfaceIndex index(sphere);
  const Eigen::Matrix3Xd points = RandomPoints(300, 0.2, 4);
  for (const auto& point : points.colwise()) {
    double nearest = std::numeric_limits<double>::infinity();
    for (int t = 0; t < sphere.TriangleCount(); ++t) {
      const Eigen::Vector3d weights = ClosestPointOnTriangle(
          sphere.Corner(t, 0), sphere.Corner(t, 1), sphere.Corner(t, 2), point);
      const Eigen::Matrix3d corners =
          (Eigen::Matrix3d() << sphere.Corner(t, 0), sphere.Corner(t, 1), sphere.Corner(t, 2))
              .finished();
      nearest = std::min(nearest, (corners * weights - point).norm());
    }
    const SurfacePoint found = index.Closest(point);
    EXPECT_NEAR(found.distance_m, nearest, 1e-15);
    EXPECT_NEAR((found.position_m - point).norm(), nearest, 1e-15);
  }
}

TEST(SurfaceIndex, GivesTiesToTheLowestTriangle) {
  const SurfaceIndex index(UnitCube());
  EXPECT_EQ(index.Closest({0.0, 0.0, 0.0}).triangle, 0);
  EXPECT_EQ(index.Closest({0.0, 0.0, 0.0}).distance_m, 0.0);
}

TEST(SurfaceIndex, TrianglesWithinARadiusAreExactlyThoseThatComeThatNear) {
  const TriangleSurface sphere = Sphere(0.1, 20, 30);
  const SurfaceIndex index(sphere);
  const Eigen::Vector3d point(0.09, 0.03, 0.02);
  const std::vector<int> found = index.TrianglesWithin(point, 0.03);
  std::vector<int> expected;
  for (int t = 0; t < sphere.TriangleCount(); ++t) {
    TriangleSurface single{sphere.vertices_m, sphere.triangles.col(t)};
    if (SurfaceIndex(single).Closest(point).distance_m <= 0.03) expected.push_back(t);
  }
  EXPECT_GT(expected.size(), 10U);
  EXPECT_EQ(found, expected);
}

TEST(SurfaceIndex, FollowsADeformedSurface) {
  TriangleSurface sphere = Sphere(0.1, 20, 30);
  SurfaceIndex index(sphere);
  sphere.vertices_m.row(2) *= 2.0;
  sphere.vertices_m.row(0).array() += 0.3;
  index.Refit(sphere.vertices_m);
  const SurfaceIndex fresh(sphere);
  const Eigen::Matrix3Xd points = RandomPoints(100, 0.5, 5);
  for (const auto& point : points.colwise()) {
    EXPECT_EQ(index.Closest(point).distance_m, fresh.Closest(point).distance_m);
  }
}

}  // namespace
}  // namespace palpate::geometry
