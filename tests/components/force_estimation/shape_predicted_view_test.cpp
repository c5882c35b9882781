// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/correspondence/predicted_view.hpp"

#include <gtest/gtest.h>

#include "libs/correspondence/moving_surface.hpp"
#include "tests/components/force_estimation/shape_scene.hpp"

namespace palpate::force_estimation {
namespace {

struct View {
  View() : surface(FourLegScene().features->triangles()) {
    surface.MoveTo(FourLegScene().rest_x_m, BenchPose().inverse());
    view.Look(surface.vertices_m(), surface.triangles());
  }

  Eigen::Vector3d Middle_m(int triangle) const {
    const Eigen::Vector3i corners = surface.triangles().col(triangle);
    return (surface.vertices_m().col(corners[0]) + surface.vertices_m().col(corners[1]) +
            surface.vertices_m().col(corners[2])) /
           3.0;
  }

  correspondence::MovingSurface surface;
  correspondence::PredictedView view;
};

/// What is seen towards a point that the camera sees lies at that point.
TEST(PredictedView, SeesThePointsOfTheCloudWhereTheyAre) {
  const View seen;
  const rgbd::SensedCloud cloud = Cast(FourLegScene(), FourLegScene().rest_x_m, BenchPose());
  int far = 0;
  int uncovered = 0;
  for (Eigen::Index k = 0; k < cloud.Count(); ++k) {
    const Eigen::Vector3d point_m = cloud.points_m.col(k).cast<double>();
    const int triangle = seen.view.TriangleAt(point_m, 3e-3);
    ASSERT_NE(triangle, rgbd::SurfaceView::kNothing);
    if ((seen.Middle_m(triangle) - point_m).norm() > 8e-3) ++far;
    EXPECT_FALSE(seen.view.Hides(point_m, 8e-3));
    if (!seen.view.Hides(1.1 * point_m, 8e-3)) ++uncovered;
  }
  EXPECT_LT(far, cloud.Count() / 50);  // beside the edges of what is in front
  EXPECT_LT(uncovered, cloud.Count() / 50);
}

TEST(PredictedView, SearchesBesideTheSilhouette) {
  const View seen;
  const rgbd::SensedCloud cloud = Cast(FourLegScene(), FourLegScene().rest_x_m, BenchPose());
  const float left_m = cloud.points_m.row(0).minCoeff();
  int beside = 0;
  for (Eigen::Index k = 0; k < cloud.Count(); ++k) {
    Eigen::Vector3d point_m = cloud.points_m.col(k).cast<double>();
    if (point_m.x() > static_cast<double>(left_m) + 1e-3) continue;
    point_m.x() -= 3e-3;
    EXPECT_EQ(seen.view.TriangleAt(point_m, 0.0), rgbd::SurfaceView::kNothing);
    const int triangle = seen.view.TriangleAt(point_m, 6e-3);
    ASSERT_NE(triangle, rgbd::SurfaceView::kNothing);
    EXPECT_LT((seen.Middle_m(triangle) - point_m).norm(), 9e-3);
    ++beside;
  }
  EXPECT_GE(beside, 1);
}

}  // namespace
}  // namespace palpate::force_estimation
