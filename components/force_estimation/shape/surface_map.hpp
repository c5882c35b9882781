// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "libs/geometry/closest_point.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// A point of the robot's surface: the same material point in every shape.
struct MaterialPoint {
  int triangle = -1;  ///< of the drawn surface
  Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();
  Eigen::Vector3d rest_m = Eigen::Vector3d::Zero();  ///< on the undeformed body, robot frame
  double distance_m = 0.0;                           ///< from the query point
};

struct SurfaceMapTuning {
  /// Step of the search through the body for its other side. Larger: faster, misses thinner walls.
  double step_m = 1e-3;
  /// Cosine of the search direction to the other side's normal: 60 degrees. Larger: only walls that
  /// are nearly parallel count as the other side.
  double least_cosine = 0.5;
};

/// The robot's surface in its undeformed and its present shape, and the map between them, by which
/// detected locations come to the model's surface (section V.A.4 of the paper, which takes the
/// nearest surface point of the robot file instead).
class SurfaceMap {
 public:
  explicit SurfaceMap(const robot::RobotModel& model, const SurfaceMapTuning& tuning = {});

  /// The present shape: `x_m` [3n].
  void Deform(const Eigen::VectorXd& x_m);

  /// The point of the present surface nearest to `position_m`.
  MaterialPoint NearestNow(const Eigen::Vector3d& position_m) const;
  /// The point of the undeformed surface nearest to `rest_m`.
  MaterialPoint NearestAtRest(const Eigen::Vector3d& rest_m) const;

  /// Of the present surface, the other side of the body behind a point: the next surface along
  /// `inward` (unit) whose normal points that way; empty where none is within `farthest_m`.
  std::optional<MaterialPoint> OtherSideNow(const MaterialPoint& point,
                                            const Eigen::Vector3d& inward, double farthest_m) const;

  Eigen::Vector3d PositionNow_m(const MaterialPoint& point) const;
  /// Unit outward normals of the triangle, now and at rest.
  Eigen::Vector3d NormalNow(const MaterialPoint& point) const;
  Eigen::Vector3d NormalAtRest(const MaterialPoint& point) const;
  /// Triangles of the surface around a point at rest, its own first, within `radius_m` and with a
  /// normal of the same direction: not those of a thin limb's other side.
  std::vector<int> TrianglesAround(const MaterialPoint& point, double radius_m) const;

 private:
  MaterialPoint PointOf(const geometry::SurfacePoint& found) const;

  SurfaceMapTuning tuning_;
  geometry::SurfaceIndex rest_;
  geometry::SurfaceIndex now_;
};

}  // namespace palpate::force_estimation
