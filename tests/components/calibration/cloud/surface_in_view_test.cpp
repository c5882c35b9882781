// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/cloud/surface_in_view.hpp"

#include <gtest/gtest.h>

#include "components/calibration/cloud/pose_search.hpp"
#include "tests/components/calibration/cloud/cloud_scene.hpp"

namespace palpate::calibration {
namespace {

geometry::TriangleSurface SurfaceOf(const robot::RobotBody& body) {
  return {body.mesh.nodes_m, body.boundary.DrawnTriangles()};
}

Eigen::Vector3d CentroidOf(const geometry::TriangleSurface& surface, int t) {
  return (surface.Corner(t, 0) + surface.Corner(t, 1) + surface.Corner(t, 2)) / 3.0;
}

/// How far before `target_m` the line from `eye_m` meets another triangle, m; 0: it does not
/// (Moeller and Trumbore 1997).
double HiddenBy_m(const geometry::TriangleSurface& surface, int own, const Eigen::Vector3d& eye_m,
                  const Eigen::Vector3d& target_m) {
  const Eigen::Vector3d ray = target_m - eye_m;
  double deepest_m = 0.0;
  for (int t = 0; t < surface.TriangleCount(); ++t) {
    if (t == own) continue;
    const Eigen::Vector3d a = surface.Corner(t, 1) - surface.Corner(t, 0);
    const Eigen::Vector3d b = surface.Corner(t, 2) - surface.Corner(t, 0);
    const Eigen::Vector3d across = ray.cross(b);
    const double determinant = a.dot(across);
    if (determinant == 0.0) continue;
    const Eigen::Vector3d from = eye_m - surface.Corner(t, 0);
    const double u = from.dot(across) / determinant;
    const double v = ray.dot(from.cross(a)) / determinant;
    const double along = b.dot(from.cross(a)) / determinant;
    if (u < 0.0 || v < 0.0 || u + v > 1.0 || along <= 0.0 || along >= 1.0) continue;
    deepest_m = std::max(deepest_m, (1.0 - along) * ray.norm());
  }
  return deepest_m;
}

class SurfaceInViewTest : public ::testing::Test {
 protected:
  void SetUp() override {
    in_view_.TakeShape(model_->RestState().x_m);
    in_view_.LookFrom(truth_);
  }

  std::unique_ptr<robot::RobotModel> model_ = Build(QuickFourLegRobot());
  geometry::RigidTransform truth_ = TruePose();
  geometry::TriangleSurface surface_ = SurfaceOf(model_->body());
  SurfaceInView in_view_{model_->body()};
};

TEST_F(SurfaceInViewTest, PlacesInViewAreTheirOwnFeet) {
  const Eigen::Matrix3Xd& places_m = in_view_.seen_places_m();
  ASSERT_GT(places_m.cols(), 5000);
  int found = 0;
  for (Eigen::Index k = 0; k < places_m.cols(); k += 23) {
    const std::optional<SurfaceFoot> foot = in_view_.FootOf(places_m.col(k));
    if (!foot) continue;  // grazing
    ++found;
    EXPECT_LT(foot->distance_m, 1e-6);
    const fem::InterpolationWeights weights = in_view_.WeightsOf(*foot);
    EXPECT_LT((weights.Position(model_->RestState().x_m) - foot->position_m).norm(), 1e-12);
  }
  EXPECT_GT(found, static_cast<int>(0.9 * static_cast<double>(places_m.cols()) / 23));
}

TEST_F(SurfaceInViewTest, NoPointIsMatchedToSurfaceThatIsTurnedAwayOrHidden) {
  const Eigen::Vector3d eye_m = truth_.translation_m();
  int turned_away = 0, hidden = 0;
  for (int t = 0; t < surface_.TriangleCount(); ++t) {
    const Eigen::Vector3d centroid_m = CentroidOf(surface_, t);
    const bool faces = geometry::TriangleNormal(surface_, t).dot(eye_m - centroid_m) > 0.0;
    if (faces && HiddenBy_m(surface_, t, eye_m, centroid_m) < 0.01) continue;
    ++(faces ? hidden : turned_away);
    const std::optional<SurfaceFoot> foot = in_view_.FootOf(centroid_m);
    if (!foot) continue;
    EXPECT_GT(foot->distance_m, 1e-6) << t;
    EXPECT_GT(foot->normal.dot(eye_m - foot->position_m), 0.0) << t;
  }
  EXPECT_GT(turned_away, 500);
  EXPECT_GT(hidden, 50);
}

TEST_F(SurfaceInViewTest, MatchesNothingUntilItLooks) {
  SurfaceInView in_view(model_->body());
  in_view.TakeShape(model_->RestState().x_m);
  EXPECT_FALSE(in_view.FootOf(Eigen::Vector3d::Zero()).has_value());
}

/// Cells are chosen by direction, so that no noise of the depth is preferred.
TEST(ThinCloud, NeighboursStayApartAndNoiseIsNotPreferred) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0.0, 2e-3);
  rgbd::SensedCloud cloud;
  cloud.points_m.resize(3, 10000);
  for (int k = 0; k < 10000; ++k) {
    const Eigen::Vector3d ray(0.002 * (k % 100), 0.002 * (k / 100), 1.0);
    cloud.points_m.col(k) = ((0.5 + noise(random)) * ray).cast<float>();
  }
  cloud.sigma_m.setConstant(10000, 2e-3f);
  const ThinCloud thin = Thin(cloud, 0.005);
  EXPECT_NEAR(static_cast<double>(thin.Count()), 400.0, 50.0);
  EXPECT_NEAR(thin.points_m.row(2).mean(), 0.5, 4.0 * 2e-3 / 20.0);
  for (Eigen::Index i = 0; i < thin.Count(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      const Eigen::Vector2d between = thin.points_m.col(i).head<2>() / thin.points_m(2, i) -
                                      thin.points_m.col(j).head<2>() / thin.points_m(2, j);
      EXPECT_GT(between.norm(), 0.006);
    }
  }
}

}  // namespace
}  // namespace palpate::calibration
