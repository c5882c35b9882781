// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/camera_view.hpp"

#include <algorithm>

namespace palpate::diagnosis {

namespace {

constexpr double kNearest_m = 1e-3;
/// Beyond 75 degrees depth sensors measure hardly anything. What is seen from farther aside counts
/// as seen from there: 1/cos a would give one such marker all the weight.
constexpr double kLeastCosine = 0.25;

bool IsBefore(const SeenPoint& point) { return point.at_m.z() > kNearest_m; }

Eigen::Vector2d TrueDirection(const SeenPoint& point) { return point.at_m.hnormalized(); }

double Cosine(const SeenPoint& point) { return -point.normal.dot(point.at_m.normalized()); }

/// z of (1/cos a - 1) along the ray.
double Slant(const SeenPoint& point) {
  return (1.0 / std::max(Cosine(point), kLeastCosine) - 1.0) * point.at_m.z() / point.at_m.norm();
}

/// d Slant / d point, 1/m.
Eigen::Vector3d SlantSlope(const SeenPoint& point) {
  const double range_m = point.at_m.norm();
  const double z_m = point.at_m.z();
  const Eigen::Vector3d of_share =
      Eigen::Vector3d::Unit(2) / range_m -
      z_m / (range_m * range_m * range_m) * point.at_m;  // of z / range
  if (Cosine(point) < kLeastCosine) return (1.0 / kLeastCosine - 1.0) * of_share;
  const double along_m = point.normal.dot(point.at_m);  // z / (range cos a) = -z / along
  return -Eigen::Vector3d::Unit(2) / along_m + z_m / (along_m * along_m) * point.normal - of_share;
}

}  // namespace

CameraView::CameraView(const CameraErrors& errors, const Eigen::Vector2d& focal_px, double drift_m)
    : errors_(errors),
      focal_px_(focal_px),
      centre_(Eigen::Vector2d(errors.cx_px, errors.cy_px).cwiseQuotient(focal_px)),
      drift_m_(drift_m) {}

double CameraView::Depth_m(const SeenPoint& point) const {
  const double smooth_m =
      errors_.bias.size() > 0
          ? errors_.bias.dot(ValuesAt(errors_.bias_basis, point.at_m)) * point.at_m.z()
          : 0.0;
  return (1.0 + errors_.depth_scale) * point.at_m.z() + drift_m_ +
         errors_.incidence_bias_m * Slant(point) + smooth_m;
}

Eigen::Vector2d CameraView::Direction(const SeenPoint& point) const {
  const Eigen::Vector2d n = TrueDirection(point);
  return (1.0 + errors_.focal) * (1.0 + errors_.k1 * n.squaredNorm()) * n + centre_;
}

Eigen::Vector3d CameraView::Measured(const SeenPoint& point) const {
  if (!IsBefore(point)) return point.at_m;
  return Depth_m(point) * Direction(point).homogeneous();
}

Eigen::Matrix3d CameraView::Slope(const SeenPoint& point) const {
  if (!IsBefore(point)) return Eigen::Matrix3d::Identity();
  const Eigen::Vector2d n = TrueDirection(point);
  Eigen::Matrix<double, 2, 3> of_n;
  of_n << Eigen::Matrix2d::Identity(), -n;
  of_n /= point.at_m.z();
  const Eigen::Matrix2d by_n =
      (1.0 + errors_.focal) * ((1.0 + errors_.k1 * n.squaredNorm()) * Eigen::Matrix2d::Identity() +
                               2.0 * errors_.k1 * n * n.transpose());
  Eigen::Vector3d of_depth = (1.0 + errors_.depth_scale) * Eigen::Vector3d::Unit(2) +
                             errors_.incidence_bias_m * SlantSlope(point);
  if (errors_.bias.size() > 0) {
    of_depth +=
        errors_.bias.dot(ValuesAt(errors_.bias_basis, point.at_m)) * Eigen::Vector3d::Unit(2) +
        point.at_m.z() * SlopesAt(errors_.bias_basis, point.at_m) * errors_.bias;
  }
  Eigen::Matrix3d slope = ByDrift(point) * of_depth.transpose();
  slope.topRows<2>() += Depth_m(point) * by_n * of_n;
  return slope;
}

Eigen::Vector3d CameraView::ByDrift(const SeenPoint& point) const {
  if (!IsBefore(point)) return Eigen::Vector3d::Zero();
  return Direction(point).homogeneous();
}

Eigen::Vector3d CameraView::ByDepthScale(const SeenPoint& point) const {
  return point.at_m.z() * ByDrift(point);
}

Eigen::Vector3d CameraView::ByIncidence(const SeenPoint& point) const {
  return Slant(point) * ByDrift(point);
}

Eigen::Vector3d CameraView::ByFocal(const SeenPoint& point) const {
  if (!IsBefore(point)) return Eigen::Vector3d::Zero();
  const Eigen::Vector2d n = TrueDirection(point);
  const Eigen::Vector2d change = (1.0 + errors_.k1 * n.squaredNorm()) * n;
  return Depth_m(point) * Eigen::Vector3d(change.x(), change.y(), 0.0);
}

Eigen::Vector3d CameraView::ByCentre(const SeenPoint& point, int axis) const {
  if (!IsBefore(point)) return Eigen::Vector3d::Zero();
  return Depth_m(point) / focal_px_[axis] * Eigen::Vector3d::Unit(axis);
}

Eigen::Vector3d CameraView::ByBias(const SeenPoint& point, const geometry::DepthBiasBasis& basis,
                                   Eigen::Index coefficient) const {
  if (!IsBefore(point)) return Eigen::Vector3d::Zero();
  return ValuesAt(basis, point.at_m)[coefficient] * ByDepthScale(point);
}

Eigen::Vector3d CameraView::ByDistortion(const SeenPoint& point) const {
  if (!IsBefore(point)) return Eigen::Vector3d::Zero();
  const Eigen::Vector2d n = TrueDirection(point);
  const Eigen::Vector2d change = (1.0 + errors_.focal) * n.squaredNorm() * n;
  return Depth_m(point) * Eigen::Vector3d(change.x(), change.y(), 0.0);
}

}  // namespace palpate::diagnosis
