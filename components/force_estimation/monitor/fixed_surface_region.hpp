// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "libs/geometry/box.hpp"
#include "libs/geometry/closest_point.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::force_estimation {

/// Point of the surface nearest to a measured one, robot frame.
struct FixedSurfacePoint {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, outward, of the body at rest
};

struct FixedSurfaceRegionTuning {
  /// Distance from fixed nodes, as a share of the body's diagonal. A beam fixed at one end bends
  /// there by less than 0.3 % of its tip's displacement. Larger: more points, which forces displace
  /// more.
  double near_share = 0.04;
};

/// The surface near the fixed nodes, which no force displaces much, wherever it acts.
class FixedSurfaceRegion {
 public:
  explicit FixedSurfaceRegion(const robot::RobotBody& body,
                              const FixedSurfaceRegionTuning& tuning = {});

  /// Whether no surface is near a fixed node.
  bool IsEmpty() const { return box_.Diagonal_m() == 0.0; }
  /// Of the box round it, robot frame.
  Eigen::Vector3d Middle_m() const { return 0.5 * (box_.lower_m + box_.upper_m); }
  /// Whether a point (robot frame) may be within `reach_m` of it; cheap.
  bool MayHold(const Eigen::Vector3d& point_m, double reach_m) const {
    return box_.SquaredDistance_m2(point_m) <= reach_m * reach_m;
  }
  /// The point of the body's surface nearest to a point (robot frame), where that is within
  /// `reach_m` and belongs to this region. `x_m` [3n]: the nodes; empty: at rest.
  std::optional<FixedSurfacePoint> PlaceOf(const Eigen::Vector3d& point_m, double reach_m,
                                           const Eigen::VectorXd& x_m) const;

 private:
  geometry::SurfaceIndex index_;  ///< of the whole surface at rest; vertices are the mesh's nodes
  std::vector<bool> is_fixed_;    ///< [triangles]
  geometry::Box box_;             ///< round the triangles that are
};

}  // namespace palpate::force_estimation
