// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "components/force_estimation/shape/surface_matching.hpp"
#include "libs/geometry/triangle_surface.hpp"
#include "tests/components/force_estimation/shape_scene.hpp"

namespace palpate::force_estimation {
namespace {

/// Whether a triangle lies between `eye_m` and `point_m`, more than 5 mm before it (Moeller and
/// Trumbore's test).
bool IsCovered(const geometry::TriangleSurface& surface, const Eigen::Vector3d& eye_m,
               const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d ray = point_m - eye_m;
  for (int t = 0; t < surface.TriangleCount(); ++t) {
    const Eigen::Vector3d ab = surface.Corner(t, 1) - surface.Corner(t, 0);
    const Eigen::Vector3d ac = surface.Corner(t, 2) - surface.Corner(t, 0);
    const Eigen::Vector3d from_a = eye_m - surface.Corner(t, 0);
    const double determinant = ab.dot(ray.cross(ac));
    if (determinant == 0.0) continue;
    const double b = from_a.dot(ray.cross(ac)) / determinant;
    const double c = ray.dot(from_a.cross(ab)) / determinant;
    const double along = ac.dot(from_a.cross(ab)) / determinant;
    const bool hit = b >= 0.0 && c >= 0.0 && b + c <= 1.0 && along > 0.0;
    if (hit && along * ray.norm() < ray.norm() - 5e-3) return true;
  }
  return false;
}

double LineDistance_m(const rgbd::SensedCloud& cloud, const Eigen::Isometry3d& T_robot_camera,
                      const Eigen::Vector3d& point_m, const Eigen::Vector3d& normal) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (Eigen::Index k = 0; k < cloud.Count(); ++k) {
    const Eigen::Vector3d seen_m = T_robot_camera * cloud.points_m.col(k).cast<double>();
    nearest_m = std::min(nearest_m, (seen_m - point_m).cross(normal).norm());
  }
  return nearest_m;
}

ShapeConfig With(const std::string& matching) {
  ShapeConfig config;
  config.matching = matching;
  return config;
}

/// Features on the far side, which the body's own points lie near the normal lines of, are not
/// matched with the front.
TEST(HiddenFeatures, WhatIsTurnedAwayIsHiddenWhateverLiesOnItsNormalLine) {
  const ShapeScene& scene = FourLegScene();
  const rgbd::SensedCloud cloud = Cast(scene, scene.rest_x_m, BenchPose());
  const Eigen::Matrix3Xd normals = scene.features->Normals(scene.rest_x_m);
  for (const char* way : {"patch", "point"}) {
    ShapeConfig config = With(way);
    config.outlier_distance_m = 0.05;  // else the thickness of the body would tell
    config.hidden_distance_m = 4e-3;
    SurfaceMatching matching(*scene.features, config);
    const auto& matches = matching.Match(FrameOf(cloud), scene.rest_x_m);
    int near_the_line = 0;
    for (int k = 0; k < scene.features->Count(); ++k) {
      const Eigen::Vector3d point_m = scene.features->rest_m().col(k);
      const Eigen::Vector3d sight = (point_m - BenchPose().translation()).normalized();
      if (normals.col(k).dot(sight) < 0.7) continue;
      EXPECT_EQ(matches[static_cast<size_t>(k)].state, correspondence::MatchState::kHidden)
          << way << k;
      if (LineDistance_m(cloud, BenchPose(), point_m, normals.col(k)) < 4e-3) ++near_the_line;
    }
    EXPECT_GE(near_the_line, 3);
  }
}

/// From the east, low: the hub and the east leg cover parts of the others that face the camera.
TEST(HiddenFeatures, WhatTheBodyItselfCoversIsHidden) {
  const ShapeScene& scene = FourLegScene();
  const Eigen::Isometry3d T_robot_camera = LookAt({0.45, 0.02, 0.09}, {0.0, 0.0, 0.06});
  const ShapeFrame frame = FrameOf(Cast(scene, scene.rest_x_m, T_robot_camera), T_robot_camera);
  const Eigen::Matrix3Xd normals = scene.features->Normals(scene.rest_x_m);
  const geometry::TriangleSurface surface{scene.model->body().mesh.nodes_m,
                                          scene.features->triangles()};
  const Eigen::Vector3d eye_m = T_robot_camera.translation();
  ShapeConfig config = With("point");
  config.outlier_distance_m = 0.2;
  config.hidden_distance_m = 0.01;
  SurfaceMatching matching(*scene.features, config);
  const auto& matches = matching.Match(frame, scene.rest_x_m);
  int covered = 0;
  int free = 0;
  for (int k = 0; k < scene.features->Count(); ++k) {
    const Eigen::Vector3d point_m = scene.features->rest_m().col(k);
    if (normals.col(k).dot((eye_m - point_m).normalized()) < 0.5) continue;
    const bool hidden =
        matches[static_cast<size_t>(k)].state == correspondence::MatchState::kHidden;
    if (IsCovered(surface, eye_m, point_m)) {
      ++covered;
      EXPECT_TRUE(hidden) << k;
    } else {
      ++free;
      EXPECT_FALSE(hidden) << k;
    }
  }
  EXPECT_GE(covered, 1);
  EXPECT_GE(free, 5);
}

TEST(HiddenFeatures, PatchesGetPointsOfWhatIsSeenOfThemOnly) {
  const ShapeScene& scene = FourLegScene();
  const Eigen::Isometry3d T_robot_camera = LookAt({0.45, 0.02, 0.09}, {0.0, 0.0, 0.06});
  const ShapeFrame frame = FrameOf(Cast(scene, scene.rest_x_m, T_robot_camera), T_robot_camera);
  SurfaceMatching matching(*scene.features, With("patch"));
  const geometry::TriangleSurface surface{scene.model->body().mesh.nodes_m,
                                          scene.features->triangles()};
  // Of each feature, whether the middle of any of its triangles is in sight.
  std::vector<bool> in_sight(51, false);
  for (int t = 0; t < surface.TriangleCount(); ++t) {
    const auto feature = static_cast<size_t>(scene.features->FeatureOfTriangle(t));
    const Eigen::Vector3d middle_m =
        (surface.Corner(t, 0) + surface.Corner(t, 1) + surface.Corner(t, 2)) / 3.0;
    const Eigen::Vector3d sight = middle_m - T_robot_camera.translation();
    if (in_sight[feature] || geometry::TriangleNormal(surface, t).dot(sight) >= 0.0) continue;
    in_sight[feature] = !IsCovered(surface, T_robot_camera.translation(), middle_m);
  }
  const auto& matches = matching.Match(frame, scene.rest_x_m);
  int hidden = 0;
  for (size_t k = 0; k < 51; ++k) {
    if (in_sight[k]) continue;
    ++hidden;
    EXPECT_EQ(matches[k].state, correspondence::MatchState::kHidden) << k;
    EXPECT_TRUE(matches[k].row.nodes.empty());
  }
  EXPECT_GE(hidden, 8);
}

TEST(HiddenFeatures, WhatIsSeenAtAGrazingAngleDoesNotCount) {
  const ShapeScene& scene = FourLegScene();
  SurfaceMatching matching(*scene.features, With("patch"));
  for (const Eigen::Vector3d& eye_m :
       {Eigen::Vector3d(0.343, -0.198, 0.275), Eigen::Vector3d(0.45, 0.02, 0.09),
        Eigen::Vector3d(-0.1, 0.3, 0.35)}) {
    const Eigen::Isometry3d pose = LookAt(eye_m, {0.0, 0.0, 0.06});
    const ShapeFrame frame = FrameOf(Cast(scene, scene.rest_x_m, pose, 2), pose);
    for (const correspondence::FeatureMatch& match : matching.Match(frame, scene.rest_x_m)) {
      if (match.state != correspondence::MatchState::kMatched) continue;
      const Eigen::Vector3d sight = pose.linear() * match.position_m.normalized();
      EXPECT_GE(-match.normal.dot(sight), 0.26);  // 75 degrees
    }
  }
}

TEST(HiddenFeatures, AShareWithFewPointsIsHidden) {
  const ShapeScene& scene = FourLegScene();
  SurfaceMatching matching(*scene.features, With("patch"));
  const ShapeFrame frame = FrameOf(Cast(scene, scene.rest_x_m, BenchPose(), 8));
  int too_few = 0;
  int enough = 0;
  for (const correspondence::FeatureMatch& match : matching.Match(frame, scene.rest_x_m)) {
    EXPECT_EQ(match.state == correspondence::MatchState::kMatched, match.count >= 8);
    ++(match.state == correspondence::MatchState::kMatched ? enough : too_few);
  }
  EXPECT_GE(enough, 5);
  EXPECT_GE(too_few, 5);
}

/// d_m of Algorithm 3.
TEST(HiddenFeatures, WithoutACloudPointNearItsNormalLineAFeatureIsHidden) {
  const ShapeScene& scene = FourLegScene();
  ShapeConfig config = With("point");
  config.hidden_distance_m = 3e-3;
  SurfaceMatching matching(*scene.features, config);
  const rgbd::SensedCloud cloud = Cast(scene, scene.rest_x_m, BenchPose());
  const Eigen::Matrix3Xd normals = scene.features->Normals(scene.rest_x_m);
  const std::vector<correspondence::FeatureMatch> matches =
      matching.Match(FrameOf(cloud), scene.rest_x_m);
  int tried = 0;
  for (int k = 0; k < scene.features->Count(); ++k) {
    if (matches[static_cast<size_t>(k)].state != correspondence::MatchState::kMatched) continue;
    EXPECT_LE(matches[static_cast<size_t>(k)].line_distance_m, 3e-3);
    rgbd::SensedCloud holed = cloud;
    Eigen::Index kept = 0;
    for (Eigen::Index p = 0; p < cloud.Count(); ++p) {
      const Eigen::Vector3d offset_m =
          BenchPose() * cloud.points_m.col(p).cast<double>() - scene.features->rest_m().col(k);
      if (offset_m.cross(normals.col(k)).norm() > 4e-3) {
        holed.points_m.col(kept++) = cloud.points_m.col(p);
      }
    }
    holed.points_m.conservativeResize(3, kept);
    holed.sigma_m.conservativeResize(kept);
    const correspondence::FeatureMatch match =
        matching.Match(FrameOf(holed), scene.rest_x_m)[static_cast<size_t>(k)];
    EXPECT_EQ(match.state, correspondence::MatchState::kHidden) << k;
    EXPECT_GT(match.line_distance_m, 3e-3);
    ++tried;
  }
  EXPECT_GE(tried, 8);
}

TEST(HiddenFeatures, WithoutACloudAllAre) {
  const ShapeScene& scene = FourLegScene();
  for (const char* way : {"patch", "point"}) {
    SurfaceMatching matching(*scene.features, With(way));
    const auto& matches = matching.Match(FrameOf({}), scene.rest_x_m);
    ASSERT_EQ(matches.size(), 51u);
    for (const correspondence::FeatureMatch& match : matches)
      EXPECT_EQ(match.state, correspondence::MatchState::kHidden);
  }
}

/// Away from the robot, in the middle of it, far off: nothing is matched, nothing breaks.
TEST(HiddenFeatures, ACameraThatCannotSeeTheRobotMatchesNothing) {
  const ShapeScene& scene = FourLegScene();
  const rgbd::SensedCloud cloud = Cast(scene, scene.rest_x_m, BenchPose());
  for (const char* way : {"patch", "point"}) {
    SurfaceMatching matching(*scene.features, With(way));
    for (const Eigen::Isometry3d& pose :
         {LookAt({0.3, -0.2, 0.3}, {0.6, -0.4, 0.5}), LookAt({0.0, 0.01, 0.06}, {0.0, 0.5, 0.0}),
          LookAt({300.0, 0.0, 0.0}, {0.0, 0.0, 0.0})}) {
      for (const correspondence::FeatureMatch& match :
           matching.Match(FrameOf(cloud, pose), scene.rest_x_m)) {
        EXPECT_NE(match.state, correspondence::MatchState::kMatched) << way;
      }
    }
  }
}

TEST(HiddenFeatures, WhatIsNotANumberIsABrokenPromise) {
  const ShapeScene& scene = FourLegScene();
  SurfaceMatching matching(*scene.features, {});
  const ShapeFrame good = FrameOf(Cast(scene, scene.rest_x_m, BenchPose(), 16));
  ShapeFrame frame = good;
  frame.views[0].cloud.points_m(1, 3) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_DEATH(matching.Match(frame, scene.rest_x_m), "points_m");
  frame = good;
  frame.views[0].cloud.sigma_m[2] = 0.0f;
  EXPECT_DEATH(matching.Match(frame, scene.rest_x_m), "sigma_m");
  frame = good;
  frame.views[0].cloud.sigma_m[2] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_DEATH(matching.Match(frame, scene.rest_x_m), "sigma_m");
  frame = good;
  frame.views[0].T_robot_camera.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_DEATH(matching.Match(frame, scene.rest_x_m), "T_robot_camera");
  Eigen::VectorXd x_m = scene.rest_x_m;
  x_m[7] = std::numeric_limits<double>::infinity();
  EXPECT_DEATH(matching.Match(good, x_m), "x_m");
}

}  // namespace
}  // namespace palpate::force_estimation
