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

/// Where a point meets the skin, robot frame.
struct HeldPlace {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, outward, of the body at rest
};

/// The skin within a twenty-fifth of the body's diagonal of the nodes that are held: no force moves
/// it by much, wherever it acts.
class FixedSurfaceRegion {
 public:
  explicit FixedSurfaceRegion(const robot::RobotBody& body);

  /// Whether nothing of the skin is near a held node.
  bool IsEmpty() const { return box_.Diagonal_m() == 0.0; }
  /// Of the box round it, robot frame.
  Eigen::Vector3d Middle_m() const { return 0.5 * (box_.lower_m + box_.upper_m); }
  /// Whether a point (robot frame) may be within `reach_m` of it; cheap.
  bool MayHold(const Eigen::Vector3d& point_m, double reach_m) const {
    return box_.SquaredDistance_m2(point_m) <= reach_m * reach_m;
  }
  /// The place of the body's skin nearest to a point (robot frame), where that is within `reach_m`
  /// and belongs to this skin. `x_m` [3n]: where the nodes are; empty: at rest.
  std::optional<HeldPlace> PlaceOf(const Eigen::Vector3d& point_m, double reach_m,
                                   const Eigen::VectorXd& x_m) const;

 private:
  geometry::SurfaceIndex index_;  ///< of the whole skin at rest; vertices are the mesh's nodes
  std::vector<bool> is_held_;     ///< [triangles]
  geometry::Box box_;             ///< round the triangles that are
};

}  // namespace palpate::force_estimation
