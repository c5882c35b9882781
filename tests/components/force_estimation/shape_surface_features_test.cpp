// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/correspondence/surface_features.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "libs/core/error.hpp"
#include "libs/geometry/triangle_surface.hpp"
#include "tests/components/force_estimation/shape_scene.hpp"
#include "tests/components/force_estimation/test_bodies.hpp"

namespace palpate::force_estimation {
namespace {

TEST(SurfaceFeatures, RefusesARobotWithoutFeaturePoints) {
  robot::RobotBody body = robot::BuildRobotBody(BeamRobot());
  body.feature_points.clear();
  body.feature_normals.resize(3, 0);
  EXPECT_THROW(correspondence::SurfaceFeatures{body}, InputError);
}

TEST(SurfaceFeatures, ArePointsOfTheBody) {
  const ShapeScene& scene = FourLegScene();
  ASSERT_EQ(scene.features->Count(), 51);
  ASSERT_EQ(scene.features->rest_m().cols(), 51);
  const Eigen::VectorXd x_m = Shifted(scene.rest_x_m, {1e-3, 2e-3, -3e-3});
  for (int k = 0; k < 51; ++k) {
    const Eigen::Vector3d expected_m = scene.features->rest_m().col(k);
    EXPECT_LT(
        (scene.features->point(k).Position(x_m) - expected_m - Eigen::Vector3d(1e-3, 2e-3, -3e-3))
            .norm(),
        1e-9);
  }
}

TEST(SurfaceFeatures, SurfaceIsTheDrawnOneWithMidEdgeNodes) {
  const ShapeScene& scene = FourLegScene();
  EXPECT_EQ(scene.features->triangles().cols(), 4 * scene.model->body().boundary.FaceCount());
}

TEST(SurfaceFeatures, NormalsPointOutwardAndTurnWithTheBody) {
  const ShapeScene& scene = FourLegScene();
  const Eigen::Matrix3Xd normals = scene.features->Normals(scene.rest_x_m);
  const Eigen::Matrix3Xd& of_faces = scene.model->body().feature_normals;
  for (int k = 0; k < 51; ++k) {
    EXPECT_NEAR(normals.col(k).norm(), 1.0, 1e-12);
    EXPECT_GT(normals.col(k).dot(of_faces.col(k)), 0.6) << k;  // less at edges
  }
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -2) / 3.0).toRotationMatrix();
  const Eigen::VectorXd turned_m = Moved(scene.rest_x_m, [&](const Eigen::Vector3d& rest_m) {
    return Eigen::Vector3d(turn * rest_m - rest_m);
  });
  EXPECT_TRUE(scene.features->Normals(turned_m).isApprox(turn * normals, 1e-10));
}

/// What a feature stands for lies around it, and on its side of the limb.
TEST(SurfaceFeatures, ShareTheSurfaceOutByPlaceAndDirection) {
  const ShapeScene& scene = FourLegScene();
  const correspondence::SurfaceFeatures& features = *scene.features;
  const geometry::TriangleSurface surface{scene.model->body().mesh.nodes_m, features.triangles()};
  const double area_m2 = geometry::SurfaceArea_m2(surface);
  const Eigen::Matrix3Xd normals = features.Normals(scene.rest_x_m);
  std::vector<double> share_m2(51, 0.0);
  double turned_away_m2 = 0.0;
  for (int t = 0; t < surface.TriangleCount(); ++t) {
    const int feature = features.FeatureOfTriangle(t);
    ASSERT_GE(feature, 0);
    ASSERT_LT(feature, 51);
    const Eigen::Vector3d area = geometry::TriangleAreaVector_m2(surface, t);
    share_m2[static_cast<size_t>(feature)] += area.norm();
    if (area.dot(normals.col(feature)) < -0.3 * area.norm()) turned_away_m2 += area.norm();
    EXPECT_LT((surface.Corner(t, 0) - features.rest_m().col(feature)).norm(), 0.04);
  }
  for (const double share : share_m2) EXPECT_NEAR(51 * share / area_m2, 1.0, 0.75);
  EXPECT_LT(turned_away_m2, 0.01 * area_m2);
}

}  // namespace
}  // namespace palpate::force_estimation
