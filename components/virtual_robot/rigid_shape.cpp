// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/rigid_shape.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "libs/core/check.hpp"
#include "libs/core/error.hpp"

namespace palpate::virtual_robot {

namespace {

constexpr double kLargestRounding_m = 1e-3;

/// Distance, its gradient and its second derivative in fewer than three coordinates, or three.
template <int dimension>
struct BoxDistance {
  double distance = 0.0;
  Eigen::Vector<double, dimension> gradient;
  Eigen::Matrix<double, dimension, dimension> curvature;
};

/// To a box; `over`: how far a point lies beyond each pair of faces, in coordinates that are all
/// >= 0.
template <int dimension>
BoxDistance<dimension> DistanceToBox(const Eigen::Vector<double, dimension>& over) {
  BoxDistance<dimension> box;
  box.curvature.setZero();
  Eigen::Index nearest = 0;
  box.distance = over.maxCoeff(&nearest);
  if (box.distance <= 0.0) {
    box.gradient = Eigen::Vector<double, dimension>::Unit(nearest);
    return box;
  }
  const Eigen::Vector<double, dimension> outside = over.cwiseMax(0.0);
  box.distance = outside.norm();
  box.gradient = outside / box.distance;
  box.curvature = -box.gradient * box.gradient.transpose();
  for (Eigen::Index i = 0; i < dimension; ++i) {
    if (over[i] > 0.0) box.curvature(i, i) += 1.0;
  }
  box.curvature /= box.distance;
  return box;
}

double Sign(double value) { return value < 0.0 ? -1.0 : 1.0; }

Clearance ToSphere(const Eigen::Vector3d& point_m, double radius_m) {
  const double from_centre_m = point_m.norm();
  Clearance clearance;
  clearance.distance_m = from_centre_m - radius_m;
  if (from_centre_m == 0.0) return clearance;
  clearance.normal = point_m / from_centre_m;
  clearance.curvature =
      (Eigen::Matrix3d::Identity() - clearance.normal * clearance.normal.transpose()) /
      from_centre_m;
  return clearance;
}

Clearance ToBox(const Eigen::Vector3d& point_m, const Eigen::Vector3d& half_m) {
  const auto box = DistanceToBox<3>(point_m.cwiseAbs() - half_m);
  const Eigen::Vector3d sign = point_m.unaryExpr(&Sign);
  return {.distance_m = box.distance,
          .normal = sign.cwiseProduct(box.gradient),
          .curvature = sign.asDiagonal() * box.curvature * sign.asDiagonal()};
}

Clearance ToCylinder(const Eigen::Vector3d& point_m, const Eigen::Vector3d& half_m) {
  const double from_axis_m = point_m.head<2>().norm();
  const auto box = DistanceToBox<2>({from_axis_m - half_m.x(), std::abs(point_m.z()) - half_m.z()});
  Eigen::Matrix<double, 3, 2> map;  // of the two coordinates' directions
  map.col(0) = Eigen::Vector3d::UnitX();
  map.col(1) = Sign(point_m.z()) * Eigen::Vector3d::UnitZ();
  if (from_axis_m > 0.0) map.col(0) << point_m.head<2>() / from_axis_m, 0.0;
  Clearance clearance{.distance_m = box.distance,
                      .normal = map * box.gradient,
                      .curvature = map * box.curvature * map.transpose()};
  if (from_axis_m > 0.0) {
    const Eigen::Vector3d around = Eigen::Vector3d::UnitZ().cross(map.col(0));
    clearance.curvature += box.gradient.x() / from_axis_m * around * around.transpose();
  }
  return clearance;
}

}  // namespace

RigidShape::RigidShape(const scenario::Tool& tool) {
  switch (tool.shape) {
    case scenario::ToolShape::kSphere:
      kind_ = Kind::kSphere;
      half_m_.setConstant(tool.radius_m);
      break;
    case scenario::ToolShape::kCylinder:
      kind_ = Kind::kCylinder;
      half_m_ << tool.radius_m, tool.radius_m, 0.5 * tool.length_m;
      break;
    case scenario::ToolShape::kPlate:
      kind_ = Kind::kBox;
      half_m_ = 0.5 * tool.size_m;
      break;
    case scenario::ToolShape::kHand: PALPATE_CHECK(false, tool.name);
  }
  half_thickness_m_ = half_m_.minCoeff();
  if (!(half_thickness_m_ > 0.0) || !half_m_.allFinite()) {
    throw InputError("tool " + tool.name + ": its sizes must be greater than 0");
  }
  if (kind_ == Kind::kSphere) {
    bounding_radius_m_ = tool.radius_m;
  } else {
    rounding_m_ = std::min(kLargestRounding_m, 0.5 * half_thickness_m_);
    bounding_radius_m_ = half_m_.norm();
  }
}

RigidShape RigidShape::HalfSpace() {
  RigidShape shape;
  shape.bounding_radius_m_ = std::numeric_limits<double>::infinity();
  shape.half_thickness_m_ = std::numeric_limits<double>::infinity();
  return shape;
}

Clearance RigidShape::Measure(const Eigen::Vector3d& point_m) const {
  const Eigen::Vector3d core_m = half_m_.array() - rounding_m_;
  Clearance clearance;
  switch (kind_) {
    case Kind::kSphere: return ToSphere(point_m, half_m_.x());
    case Kind::kHalfSpace: {
      clearance.distance_m = point_m.z();
      return clearance;
    }
    case Kind::kBox: clearance = ToBox(point_m, core_m); break;
    case Kind::kCylinder: clearance = ToCylinder(point_m, core_m); break;
  }
  clearance.distance_m -= rounding_m_;
  return clearance;
}

}  // namespace palpate::virtual_robot
