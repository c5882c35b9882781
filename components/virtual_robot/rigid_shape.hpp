// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "libs/scenario/scenario.hpp"

namespace palpate::virtual_robot {

/// How far a point is from a rigid shape, and in which direction.
struct Clearance {
  double distance_m = 0.0;                              ///< < 0 inside
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();    ///< unit, out of the shape
  Eigen::Matrix3d curvature = Eigen::Matrix3d::Zero();  ///< dnormal/dpoint, 1/m
};

/// A rigid shape in its own frame (scenario.hpp: Tool), as a signed distance. Edges of cylinders
/// and plates are rounded by 1 mm, or a quarter of the thinnest part where that is less, so that
/// the normal turns about them instead of jumping.
class RigidShape {
 public:
  /// Not of a hand, which touches nothing. Throws InputError where a size is not greater than 0.
  explicit RigidShape(const scenario::Tool& tool);
  /// The half-space z <= 0 of its own frame.
  static RigidShape HalfSpace();

  Clearance Measure(const Eigen::Vector3d& point_m) const;
  /// Of a ball about the origin that holds the shape; infinite for the half-space.
  double bounding_radius_m() const { return bounding_radius_m_; }
  /// The deepest that a point can lie inside: what moves farther in one step may come out behind.
  double half_thickness_m() const { return half_thickness_m_; }

 private:
  enum class Kind { kSphere, kCylinder, kBox, kHalfSpace };

  RigidShape() = default;

  Kind kind_ = Kind::kHalfSpace;
  Eigen::Vector3d half_m_ =
      Eigen::Vector3d::Zero();  ///< box; cylinder: radius, radius, half length
  double rounding_m_ = 0.0;
  double bounding_radius_m_ = 0.0;
  double half_thickness_m_ = 0.0;
};

}  // namespace palpate::virtual_robot
