// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/surface_map.hpp"

#include "libs/fem/boundary_surface.hpp"

namespace palpate::force_estimation {

namespace {

geometry::TriangleSurface DrawnSurface(const robot::RobotModel& model) {
  const fem::TetMesh& mesh = model.body().mesh;
  return {mesh.nodes_m, fem::ExtractBoundary(mesh).DrawnTriangles()};
}

Eigen::Vector3d Interpolate(const geometry::TriangleSurface& surface, const MaterialPoint& point) {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    position += point.barycentric[i] * surface.Corner(point.triangle, i);
  }
  return position;
}

}  // namespace

SurfaceMap::SurfaceMap(const robot::RobotModel& model, const SurfaceMapTuning& tuning)
    : tuning_(tuning), rest_(DrawnSurface(model)), now_(rest_.surface()) {}

void SurfaceMap::Deform(const Eigen::VectorXd& x_m) {
  now_.Refit(Eigen::Map<const Eigen::Matrix3Xd>(x_m.data(), 3, x_m.size() / 3));
}

MaterialPoint SurfaceMap::PointOf(const geometry::SurfacePoint& found) const {
  MaterialPoint point{.triangle = found.triangle, .barycentric = found.barycentric};
  point.rest_m = Interpolate(rest_.surface(), point);
  point.distance_m = found.distance_m;
  return point;
}

MaterialPoint SurfaceMap::NearestNow(const Eigen::Vector3d& position_m) const {
  return PointOf(now_.Closest(position_m));
}

MaterialPoint SurfaceMap::NearestAtRest(const Eigen::Vector3d& rest_m) const {
  return PointOf(rest_.Closest(rest_m));
}

std::optional<MaterialPoint> SurfaceMap::OtherSideNow(const MaterialPoint& point,
                                                      const Eigen::Vector3d& inward,
                                                      double farthest_m) const {
  const Eigen::Vector3d start_m = PositionNow_m(point);
  for (double depth_m = tuning_.step_m; depth_m <= farthest_m; depth_m += tuning_.step_m) {
    const MaterialPoint next = NearestNow(start_m + depth_m * inward);
    if (next.distance_m <= tuning_.step_m && NormalNow(next).dot(inward) > tuning_.least_cosine)
      return next;
  }
  return std::nullopt;
}

Eigen::Vector3d SurfaceMap::PositionNow_m(const MaterialPoint& point) const {
  return Interpolate(now_.surface(), point);
}

Eigen::Vector3d SurfaceMap::NormalNow(const MaterialPoint& point) const {
  return geometry::TriangleNormal(now_.surface(), point.triangle);
}

Eigen::Vector3d SurfaceMap::NormalAtRest(const MaterialPoint& point) const {
  return geometry::TriangleNormal(rest_.surface(), point.triangle);
}

std::vector<int> SurfaceMap::TrianglesAround(const MaterialPoint& point, double radius_m) const {
  const Eigen::Vector3d normal = NormalAtRest(point);
  std::vector<int> around = {point.triangle};
  for (const int triangle : rest_.TrianglesWithin(point.rest_m, radius_m)) {
    const bool faces = geometry::TriangleNormal(rest_.surface(), triangle).dot(normal) > 0.0;
    if (faces && triangle != point.triangle) around.push_back(triangle);
  }
  return around;
}

}  // namespace palpate::force_estimation
