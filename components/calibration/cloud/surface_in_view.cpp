// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/cloud/surface_in_view.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "libs/core/index.hpp"

namespace palpate::calibration {

namespace {

/// A finer z-buffer costs time. Stricter angles lose points at the outline.
struct SurfaceInViewTuning {
  int side_px = 192;       ///< width and height of the z-buffer
  double widest = 3.0;     ///< tangent of the widest view; beyond, the camera is inside the robot
  double hidden_m = 4e-3;  ///< depth behind the nearest surface; less may be rounding on a slope
  double grazing = 0.15;   ///< cosine below which a pose error moves the point along the surface
  double open = 0.4;       ///< cosine above which a point has its full weight
};
constexpr SurfaceInViewTuning kInViewTuning;
constexpr int kSide_px = kInViewTuning.side_px;
constexpr double kCentre_px = 0.5 * (kSide_px - 1);

}  // namespace

SurfaceInView::SurfaceInView(const robot::RobotBody& body)
    : view_(rgbd::CameraModel{.width_px = kSide_px,
                              .height_px = kSide_px,
                              .fx_px = 1.0,
                              .fy_px = 1.0,
                              .cx_px = kCentre_px,
                              .cy_px = kCentre_px}) {
  surface_.triangles = body.boundary.DrawnTriangles();
  const int* first = surface_.triangles.data();
  nodes_.assign(first, first + surface_.triangles.size());
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  for (int& node : surface_.triangles.reshaped()) {
    node = static_cast<int>(std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin());
  }
}

void SurfaceInView::TakeShape(const Eigen::VectorXd& x_m) {
  surface_.vertices_m.resize(3, ToIndex(nodes_.size()));
  for (std::size_t v = 0; v < nodes_.size(); ++v) {
    surface_.vertices_m.col(ToIndex(v)) = x_m.segment<3>(3 * nodes_[v]);
  }
  const Eigen::Matrix3Xd at_vertices = geometry::VertexNormals(surface_);
  const int count = surface_.TriangleCount();
  normals_.resize(3, count);
  facet_error_m_.resize(count);
  for (int t = 0; t < count; ++t) {
    normals_.col(t) = geometry::TriangleNormal(surface_, t);
    double largest_m = 0.0;
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3;
      const Eigen::Vector3d n0 = at_vertices.col(surface_.triangles(k, t));
      const Eigen::Vector3d n1 = at_vertices.col(surface_.triangles(next, t));
      const double angle_rad = std::atan2(n0.cross(n1).norm(), n0.dot(n1));
      const double edge_m = (surface_.Corner(t, k) - surface_.Corner(t, next)).norm();
      largest_m = std::max(largest_m, edge_m * angle_rad / 8.0);
    }
    facet_error_m_[t] = largest_m;
  }
}

void SurfaceInView::LookFrom(const geometry::RigidTransform& T_robot_camera) {
  eye_m_ = T_robot_camera.translation_m();
  seen_.clear();
  seen_index_.reset();
  seen_places_m_.resize(3, 0);
  triangle_of_place_.clear();
  if (!Aim()) return;
  view_.Look(aimed_m_, surface_.triangles);
  CollectSeen();
}

/// Turns the view to the centre of the surface, with the largest focal length that holds all of it.
bool SurfaceInView::Aim() {
  const Eigen::Vector3d middle_m =
      0.5 * (surface_.vertices_m.rowwise().minCoeff() + surface_.vertices_m.rowwise().maxCoeff()) -
      eye_m_;
  if (middle_m.norm() < rgbd::SurfaceView::kNearest_m) return false;
  turn_ = Eigen::Quaterniond::FromTwoVectors(middle_m, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  aimed_m_ = turn_ * (surface_.vertices_m.colwise() - eye_m_);
  double widest = 0.0;
  for (const auto& vertex : aimed_m_.colwise()) {
    if (vertex.z() < rgbd::SurfaceView::kNearest_m) continue;
    widest = std::max(widest, vertex.head<2>().cwiseAbs().maxCoeff() / vertex.z());
  }
  if (!(widest > 0.0)) return false;
  focal_px_ = (kCentre_px - 1.0) / std::min(widest, kInViewTuning.widest);
  aimed_m_.topRows<2>() *= focal_px_;
  return true;
}

void SurfaceInView::CollectSeen() {
  std::vector<bool> is_seen(static_cast<size_t>(surface_.TriangleCount()), false);
  std::vector<Eigen::Vector3d> places_m;
  const rgbd::SurfaceView::Bounds& bounds = view_.bounds();
  for (int v = bounds.v_begin; v < bounds.v_end; ++v) {
    for (int u = bounds.u_begin; u < bounds.u_end; ++u) {
      const int triangle = view_.Triangle(u, v);
      if (triangle == rgbd::SurfaceView::kNothing) continue;
      is_seen[At(triangle)] = true;
      triangle_of_place_.push_back(triangle);
      const auto z_m = static_cast<double>(view_.Z_m(u, v));
      const Eigen::Vector3d aimed((u - kCentre_px) / focal_px_, (v - kCentre_px) / focal_px_, 1.0);
      places_m.push_back(eye_m_ + turn_.transpose() * (z_m * aimed));
    }
  }
  for (int t = 0; t < surface_.TriangleCount(); ++t) {
    const Eigen::Vector3d sight_m = eye_m_ - surface_.Corner(t, 0);
    if (is_seen[At(t)] && normals_.col(t).dot(sight_m) > 0.0) seen_.push_back(t);
  }
  seen_places_m_.resize(3, ToIndex(places_m.size()));
  for (std::size_t k = 0; k < places_m.size(); ++k) {
    seen_places_m_.col(ToIndex(k)) = places_m[k];
  }
  if (seen_.empty()) return;
  geometry::TriangleSurface part{surface_.vertices_m, {}};
  part.triangles.resize(3, ToIndex(seen_.size()));
  for (std::size_t k = 0; k < seen_.size(); ++k) {
    part.triangles.col(ToIndex(k)) = surface_.triangles.col(seen_[k]);
  }
  seen_index_ = std::make_unique<geometry::SurfaceIndex>(std::move(part));
}

bool SurfaceInView::IsHidden(const Eigen::Vector3d& place_robot_m) const {
  const Eigen::Vector3d aimed_m = turn_ * (place_robot_m - eye_m_);
  if (aimed_m.z() < rgbd::SurfaceView::kNearest_m) return true;
  const double scale_px = focal_px_ / aimed_m.z();
  const int u_px = static_cast<int>(std::lround(kCentre_px + scale_px * aimed_m.x()));
  const int v_px = static_cast<int>(std::lround(kCentre_px + scale_px * aimed_m.y()));
  // At an outline the neighbouring pixels count, too: visibility there is random.
  for (int v = std::max(0, v_px - 1); v <= std::min(kSide_px - 1, v_px + 1); ++v) {
    for (int u = std::max(0, u_px - 1); u <= std::min(kSide_px - 1, u_px + 1); ++u) {
      const auto nearest_m = static_cast<double>(view_.Z_m(u, v));
      if (nearest_m > 0.0 && nearest_m < aimed_m.z() - kInViewTuning.hidden_m) return true;
    }
  }
  return false;
}

std::optional<SurfaceFoot> SurfaceInView::FootOf(const Eigen::Vector3d& point_robot_m) const {
  if (!seen_index_) return std::nullopt;
  const geometry::SurfacePoint nearest = seen_index_->Closest(point_robot_m);
  const int triangle = seen_[At(nearest.triangle)];
  const Eigen::Vector3d normal = normals_.col(triangle);
  const Eigen::Vector3d sight = (eye_m_ - nearest.position_m).normalized();
  const double cosine = normal.dot(sight);
  if (cosine < kInViewTuning.grazing || IsHidden(nearest.position_m)) return std::nullopt;
  return SurfaceFoot{.triangle = triangle,
                     .barycentric = nearest.barycentric,
                     .position_m = nearest.position_m,
                     .normal = normal,
                     .distance_m = nearest.distance_m,
                     .openness = std::min(1.0, (cosine - kInViewTuning.grazing) /
                                                   (kInViewTuning.open - kInViewTuning.grazing))};
}

fem::InterpolationWeights SurfaceInView::WeightsOf(const SurfaceFoot& foot) const {
  fem::InterpolationWeights weights;
  for (int k = 0; k < 3; ++k) {
    const int vertex = surface_.triangles(k, foot.triangle);
    weights.nodes.push_back(nodes_[At(vertex)]);
    weights.weights.push_back(foot.barycentric[k]);
  }
  return weights;
}

}  // namespace palpate::calibration
