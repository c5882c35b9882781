// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/support/sensing/scene_sight.hpp"

#include <algorithm>

namespace palpate::test_support {

namespace {

constexpr double kSameDepth_m = 1e-3;    ///< seen squarely; more where it is seen edge-on
constexpr double kSmallestCosine = 0.1;  ///< beyond it nothing counts as seen

}  // namespace

Eigen::Vector3d Centroid_m(const geometry::TriangleSurface& surface, int triangle) {
  return (surface.Corner(triangle, 0) + surface.Corner(triangle, 1) + surface.Corner(triangle, 2)) /
         3.0;
}

SceneSight::SceneSight(const SensingScene& scene, std::size_t camera)
    : scene_{scene},
      camera_{camera},
      surface_{.vertices_m = scene.state().nodes_m, .triangles = scene.triangles()},
      view_{scene.camera(camera).depth} {
  Look();
}

void SceneSight::Look() {
  surface_.vertices_m = scene_.state().nodes_m;
  view_.Look(scene_.NodesInCamera_m(camera_), surface_.triangles);
}

double SceneSight::SeenShare(const Eigen::Vector3d& position_m, double radius_m) const {
  double near_m2 = 0.0;
  double seen_m2 = 0.0;
  for (int t = 0; t < surface_.TriangleCount(); ++t) {
    const Eigen::Vector3d centroid_m = Centroid_m(surface_, t);
    if ((centroid_m - position_m).squaredNorm() > radius_m * radius_m) continue;
    const Eigen::Vector3d area_m2 = geometry::TriangleAreaVector_m2(surface_, t);
    near_m2 += area_m2.norm();
    if (IsSeen(centroid_m, area_m2.normalized())) seen_m2 += area_m2.norm();
  }
  return near_m2 > 0.0 ? seen_m2 / near_m2 : 0.0;
}

bool SceneSight::IsSeen(const Eigen::Vector3d& centroid_m, const Eigen::Vector3d& normal) const {
  const Eigen::Isometry3d T_camera_robot = scene_.T_robot_camera(camera_).inverse();
  const Eigen::Vector3d point_m = T_camera_robot * centroid_m;
  const double cosine = -(T_camera_robot.linear() * normal).dot(point_m.normalized());
  if (point_m.z() < rgbd::SurfaceView::kNearest_m || cosine < kSmallestCosine) return false;
  const Eigen::Array2d pixel = rgbd::Project(view_.camera(), point_m).array().round();
  const Eigen::Array2d last(view_.camera().width_px - 1, view_.camera().height_px - 1);
  if (!((pixel >= 0.0).all() && (pixel <= last).all())) return false;
  const auto z_m =
      static_cast<double>(view_.Z_m(static_cast<int>(pixel.x()), static_cast<int>(pixel.y())));
  return z_m > 0.0 && point_m.z() < z_m + kSameDepth_m / cosine;
}

}  // namespace palpate::test_support
