// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/correspondence/predicted_view.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "libs/core/index.hpp"

namespace palpate::correspondence {

namespace {

using rgbd::SurfaceView;

constexpr double kCentre_px = 0.5 * (PredictedView::kSide_px - 1);
/// Half the angle of the view is at most 63 degrees.
constexpr double kWidest = 2.0;
/// A search at the silhouette is for stragglers; it shall not cost more than the points.
constexpr int kFarthestSearch_px = 8;

}  // namespace

PredictedView::PredictedView()
    : view_({.width_px = kSide_px,
             .height_px = kSide_px,
             .fx_px = 1.0,
             .fy_px = 1.0,
             .cx_px = kCentre_px,
             .cy_px = kCentre_px}) {}

void PredictedView::Look(const Eigen::Matrix3Xd& vertices_m, const Eigen::Matrix3Xi& triangles) {
  if (Aim(vertices_m)) {
    aimed_m_.noalias() = aim_ * vertices_m;
  } else {
    aimed_m_.setZero(3, vertices_m.cols());  // too near: nothing is drawn
  }
  TakeFacing(vertices_m, triangles);
  view_.Look(aimed_m_, facing_.leftCols(ToIndex(numbers_.size())));
}

void PredictedView::TakeFacing(const Eigen::Matrix3Xd& vertices_m,
                               const Eigen::Matrix3Xi& triangles) {
  facing_.resize(3, triangles.cols());
  numbers_.clear();
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const Eigen::Vector3d a = vertices_m.col(triangles(0, t));
    const Eigen::Vector3d b = vertices_m.col(triangles(1, t));
    const Eigen::Vector3d c = vertices_m.col(triangles(2, t));
    if (a.dot(b.cross(c)) >= 0.0) continue;
    facing_.col(ToIndex(numbers_.size())) = triangles.col(t);
    numbers_.push_back(static_cast<int>(t));
  }
}

/// Towards the middle of the surface, and as near as keeps it in the image.
bool PredictedView::Aim(const Eigen::Matrix3Xd& vertices_m) {
  aim_.setZero();
  const Eigen::Vector3d middle_m =
      0.5 * (vertices_m.rowwise().minCoeff() + vertices_m.rowwise().maxCoeff());
  if (middle_m.norm() < SurfaceView::kNearest_m) return false;
  const Eigen::Matrix3d turn =
      Eigen::Quaterniond::FromTwoVectors(middle_m, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Eigen::Array2d low = Eigen::Array2d::Constant(kWidest);
  Eigen::Array2d high = -low;
  for (const auto& vertex : vertices_m.colwise()) {
    const Eigen::Vector3d turned_m = turn * vertex;
    if (turned_m.z() < SurfaceView::kNearest_m) continue;
    const Eigen::Array2d slope = turned_m.head<2>().array() / turned_m.z();
    low = low.min(slope.max(-kWidest));
    high = high.max(slope.min(kWidest));
  }
  const double extent = (high - low).maxCoeff();
  if (!(extent > 0.0)) return false;
  constexpr double kMargin_px = 2.0;
  scale_px_ = (kSide_px - 1 - 2.0 * kMargin_px) / extent;
  const Eigen::Vector2d centre = 0.5 * (low + high).matrix();
  aim_.row(0) = scale_px_ * (turn.row(0) - centre.x() * turn.row(2));
  aim_.row(1) = scale_px_ * (turn.row(1) - centre.y() * turn.row(2));
  aim_.row(2) = turn.row(2);
  return true;
}

bool PredictedView::Inside(int u_px, int v_px) const {
  const SurfaceView::Bounds& drawn = view_.bounds();
  return u_px >= drawn.u_begin && u_px < drawn.u_end && v_px >= drawn.v_begin && v_px < drawn.v_end;
}

bool PredictedView::PixelOf(const Eigen::Vector3d& point_m, Eigen::Vector2i* pixel,
                            double* z_m) const {
  const Eigen::Vector3d aimed_m = aim_ * point_m;
  *z_m = aimed_m.z();
  if (*z_m < SurfaceView::kNearest_m) return false;
  const Eigen::Array2d exact_px = aimed_m.head<2>().array() / *z_m + kCentre_px;
  if ((exact_px.abs() > 2.0 * kSide_px).any()) return false;
  *pixel = exact_px.round().cast<int>().matrix();
  return true;
}

int PredictedView::TriangleAt(const Eigen::Vector3d& point_m, double search_m) const {
  Eigen::Vector2i at;
  double z_m = 0.0;
  if (!PixelOf(point_m, &at, &z_m)) return SurfaceView::kNothing;
  if (Inside(at.x(), at.y())) {
    const int seen = view_.Triangle(at.x(), at.y());
    if (seen != SurfaceView::kNothing) return numbers_[At(seen)];
  }
  const int reach_px =
      static_cast<int>(std::min<double>(search_m * scale_px_ / z_m, kFarthestSearch_px));
  int best = SurfaceView::kNothing;
  int best_squared_px2 = reach_px * reach_px + 1;
  for (int v = -reach_px; v <= reach_px; ++v) {
    for (int u = -reach_px; u <= reach_px; ++u) {
      const int squared_px2 = u * u + v * v;
      if (squared_px2 >= best_squared_px2 || !Inside(at.x() + u, at.y() + v)) continue;
      const int seen = view_.Triangle(at.x() + u, at.y() + v);
      if (seen == SurfaceView::kNothing) continue;
      best = seen;
      best_squared_px2 = squared_px2;
    }
  }
  return best == SurfaceView::kNothing ? best : numbers_[At(best)];
}

bool PredictedView::Hides(const Eigen::Vector3d& point_m, double tolerance_m) const {
  Eigen::Vector2i at;
  double z_m = 0.0;
  if (!PixelOf(point_m, &at, &z_m) || !Inside(at.x(), at.y())) return false;
  const double seen_m = static_cast<double>(view_.Z_m(at.x(), at.y()));
  return seen_m > 0.0 && seen_m < z_m - tolerance_m;
}

}  // namespace palpate::correspondence
