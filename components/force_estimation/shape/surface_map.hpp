// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "libs/geometry/closest_point.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// A place on the robot's skin: the same material point in every shape.
struct SkinPoint {
  int triangle = -1;  ///< of the drawn surface
  Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();
  Eigen::Vector3d rest_m = Eigen::Vector3d::Zero();  ///< on the undeformed body, robot frame
  double distance_m = 0.0;                           ///< from the point that was asked for
};

/// The robot's skin in its undeformed and its present shape, and the way between them: detected
/// locations are mapped to the model's surface with it (section V.A.4 of the paper, which takes the
/// nearest feature point instead).
class SurfaceMap {
 public:
  explicit SurfaceMap(const robot::RobotModel& model);

  /// The present shape: `x_m` [3n].
  void Deform(const Eigen::VectorXd& x_m);

  /// The point of the present surface nearest to `position_m`.
  SkinPoint NearestNow(const Eigen::Vector3d& position_m) const;
  /// The point of the undeformed surface nearest to `rest_m`.
  SkinPoint NearestAtRest(const Eigen::Vector3d& rest_m) const;

  /// Of the present surface, the other side of the body behind a point: the next skin along
  /// `inward` (unit) that faces that way; none within `farthest_m`.
  std::optional<SkinPoint> OtherSideNow(const SkinPoint& point, const Eigen::Vector3d& inward,
                                        double farthest_m) const;

  Eigen::Vector3d PositionNow_m(const SkinPoint& point) const;
  /// Unit outward normals of the triangle, now and at rest.
  Eigen::Vector3d NormalNow(const SkinPoint& point) const;
  Eigen::Vector3d NormalAtRest(const SkinPoint& point) const;
  /// Triangles of the skin around a point at rest, its own first, as far as `radius_m` and as they
  /// face the same way: not those of a thin limb's other side.
  std::vector<int> TrianglesAround(const SkinPoint& point, double radius_m) const;

 private:
  SkinPoint PointOf(const geometry::SurfacePoint& found) const;

  geometry::SurfaceIndex rest_;
  geometry::SurfaceIndex now_;
};

}  // namespace palpate::force_estimation
