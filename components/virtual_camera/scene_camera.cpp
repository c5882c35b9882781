// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_camera/scene_camera.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace palpate::virtual_camera {

namespace {

// Room behind the lamps: what is seen where there is nothing.
constexpr std::array<float, 3> kDarkness = {0.10F, 0.10F, 0.11F};

// Where the edge from a point before the nearest plane to one behind it crosses that plane. Always
// asked in this order, so that triangles that share the edge are cut at the same point.
Eigen::Vector3d CutAtNearest(const Eigen::Vector3d& before, const Eigen::Vector3d& behind) {
  const double share = (before.z() - kNearest_m) / (before.z() - behind.z());
  Eigen::Vector3d cut = before + share * (behind - before);
  cut.z() = kNearest_m;
  return cut;
}

void CopyRow(const Eigen::Vector3d& from, float* to) {
  for (int k = 0; k < 3; ++k) to[k] = static_cast<float>(from[k]);
}

// Bounds of a round shape in the normalised image (columns: min, max), from those of a box around
// it; without bounds where the box reaches behind the nearest plane.
Eigen::Array<double, 2, 2> BoundsOf(const DrawnRound& shape, const Eigen::Isometry3d& T) {
  const double height = shape.half_length_m + (shape.round_ends ? shape.radius_m : 0.0);
  Eigen::Array<double, 2, 2> bounds;
  bounds.col(0).setConstant(std::numeric_limits<double>::infinity());
  bounds.col(1) = -bounds.col(0);
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d signs(corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0,
                                corner & 4 ? 1.0 : -1.0);
    const Eigen::Vector3d size(shape.radius_m, shape.radius_m, height);
    const Eigen::Vector3d seen = T * Eigen::Vector3d(signs.cwiseProduct(size));
    if (seen.z() < kNearest_m) {
      bounds.col(0).setConstant(-1e9);
      bounds.col(1).setConstant(1e9);
      return bounds;
    }
    const Eigen::Array2d place = seen.head<2>().array() / seen.z();
    bounds.col(0) = bounds.col(0).min(place);
    bounds.col(1) = bounds.col(1).max(place);
  }
  return bounds;
}

}  // namespace

SceneCamera::SceneCamera(const rgbd::CameraModel& camera, const kernels::Kernels& loops)
    : z_buffer_{camera, loops} {}

void SceneCamera::Look(const Drawing& drawing, const Eigen::Isometry3d& T_robot_camera) {
  const Eigen::Isometry3d T_camera_robot = T_robot_camera.inverse();
  flat_.clear();
  facets_.clear();
  disc_list_.clear();
  rounds_.clear();
  round_surfaces_.clear();
  round_bounds_.clear();
  for (const DrawnMesh& mesh : drawing.meshes) AddMesh(mesh, T_camera_robot);
  for (const DrawnRound& shape : drawing.rounds) AddRound(shape, T_camera_robot);
  z_buffer_.Clear();
  z_buffer_.Draw(flat_);
  for (std::size_t i = 0; i < rounds_.size(); ++i) {
    z_buffer_.Draw(round_surfaces_[i], static_cast<std::uint32_t>(facets_.size() + i + 1),
                   round_bounds_[i].col(0), round_bounds_[i].col(1));
  }
  z_buffer_.Finish();
  palette_.facet_count = static_cast<std::uint32_t>(facets_.size());
  palette_.facets = facets_.data();
  palette_.rounds = rounds_.data();
  palette_.paints = drawing.paints.data();
  palette_.discs = drawing.discs.data();
  palette_.disc_list = disc_list_.data();
  palette_.lamps.ambient = static_cast<float>(drawing.lighting.ambient);
  for (int lamp = 0; lamp < 2; ++lamp) {
    CopyRow(T_camera_robot.linear() * drawing.lighting.to_lamp.col(lamp),
            palette_.lamps.direction[lamp]);
    palette_.lamps.intensity[lamp] = static_cast<float>(drawing.lighting.intensity[lamp]);
  }
  palette_.pixel_angle = static_cast<float>(1.0 / camera().fx_px);
  for (std::size_t k = 0; k < 3; ++k) palette_.background[k] = kDarkness[k];
}

void SceneCamera::AddMesh(const DrawnMesh& mesh, const Eigen::Isometry3d& T_camera_robot) {
  seen_m_ = (T_camera_robot.linear() * mesh.vertices_m).colwise() + T_camera_robot.translation();
  on_canvas_.resize(2, seen_m_.cols());
  for (Eigen::Index i = 0; i < seen_m_.cols(); ++i) {
    const Eigen::Array2d place = seen_m_.col(i).head<2>().array() / seen_m_(2, i);
    on_canvas_.col(i) = z_buffer_.canvas_scale() * place + z_buffer_.canvas_offset();
  }
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) AddFacet(mesh, t);
}

bool SceneCamera::IsInView(const Eigen::Vector3i& corners) const {
  const Eigen::Vector2d a = on_canvas_.col(corners[0]);
  const Eigen::Vector2d b = on_canvas_.col(corners[1]);
  const Eigen::Vector2d c = on_canvas_.col(corners[2]);
  const Eigen::Array2d low = a.cwiseMin(b).cwiseMin(c);
  const Eigen::Array2d high = a.cwiseMax(b).cwiseMax(c);
  return (high >= z_buffer_.canvas_min()).all() && (low <= z_buffer_.canvas_max()).all();
}

void SceneCamera::AddFacet(const DrawnMesh& mesh, Eigen::Index triangle) {
  const Eigen::Vector3i corners = mesh.triangles.col(triangle);
  const Eigen::Vector3d p0 = seen_m_.col(corners[0]);
  const Eigen::Vector3d p1 = seen_m_.col(corners[1]);
  const Eigen::Vector3d p2 = seen_m_.col(corners[2]);
  const int behind = (p0.z() < kNearest_m) + (p1.z() < kNearest_m) + (p2.z() < kNearest_m);
  if (behind == 3 || (behind == 0 && !IsInView(corners))) return;
  // Barycentric coordinates divided by z are linear in the ray: row i of `shares` times (x, y, 1).
  Eigen::Matrix3d shares;
  shares.row(0) = p1.cross(p2);
  const double volume = shares.row(0).dot(p0);
  if (volume == 0.0 || (mesh.closed && volume > 0.0)) return;
  shares.row(1) = p2.cross(p0);
  shares.row(2) = p0.cross(p1);
  shares /= volume;
  const Eigen::Vector3d inverse_z = shares.colwise().sum();
  const std::size_t first = flat_.size();
  AddFlatTriangles(corners, inverse_z);
  if (flat_.size() == first) return;
  kernels::Facet& facet = facets_.emplace_back();
  for (int k = 0; k < 3; ++k) {
    const Eigen::RowVector3d corner_values(mesh.texture_m(k, corners[0]),
                                           mesh.texture_m(k, corners[1]),
                                           mesh.texture_m(k, corners[2]));
    CopyRow((corner_values * shares).transpose(), facet.texture[k]);
  }
  const Eigen::RowVector3d light(mesh.light[corners[0]], mesh.light[corners[1]],
                                 mesh.light[corners[2]]);
  CopyRow((light * shares).transpose(), facet.light);
  facet.inverse_normal_length = static_cast<float>(1.0 / inverse_z.norm());
  facet.paint = mesh.paint;
  facet.first_disc = static_cast<int>(disc_list_.size());
  if (!mesh.disc_begin.empty()) {
    const auto t = static_cast<std::size_t>(triangle);
    disc_list_.insert(disc_list_.end(), mesh.disc_list.begin() + mesh.disc_begin[t],
                      mesh.disc_list.begin() + mesh.disc_begin[t + 1]);
  }
  facet.disc_count = static_cast<int>(disc_list_.size()) - facet.first_disc;
}

void SceneCamera::AddFlatTriangles(const Eigen::Vector3i& corners,
                                   const Eigen::Vector3d& inverse_z) {
  const Eigen::Array2d scale = z_buffer_.canvas_scale();
  const Eigen::Array2d offset = z_buffer_.canvas_offset();
  Eigen::Vector3d plane = inverse_z;
  plane.head<2>().array() /= scale;
  plane.z() -= (plane.head<2>().array() * offset).sum();
  std::array<Eigen::Vector2d, 4> kept;
  std::size_t count = 0;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Index here = corners[k];
    const Eigen::Index next = corners[(k + 1) % 3];
    const bool here_before = seen_m_(2, here) >= kNearest_m;
    const bool next_before = seen_m_(2, next) >= kNearest_m;
    if (here_before) kept[count++] = on_canvas_.col(here);
    if (here_before == next_before) continue;
    const Eigen::Vector3d cut = here_before ? CutAtNearest(seen_m_.col(here), seen_m_.col(next))
                                            : CutAtNearest(seen_m_.col(next), seen_m_.col(here));
    kept[count++] = scale * (cut.head<2>().array() / cut.z()) + offset;
  }
  AddFlatTriangle(kept[0], kept[1], kept[2], plane);
  if (count == 4) AddFlatTriangle(kept[0], kept[2], kept[3], plane);
}

void SceneCamera::AddFlatTriangle(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                  const Eigen::Vector2d& c, const Eigen::Vector3d& inverse_z) {
  const Eigen::Vector2d* p[3] = {&a, &b, &c};
  const auto sort = [&p](int i, int j) {
    const bool after = p[i]->y() > p[j]->y() ||  //
                       (p[i]->y() == p[j]->y() && p[i]->x() > p[j]->x());
    if (after) std::swap(p[i], p[j]);
  };
  sort(0, 1);
  sort(1, 2);
  sort(0, 1);
  // Between two rows of pixels: nothing to draw.
  if (!z_buffer_.camera().distorted() && std::ceil(p[0]->y()) >= std::ceil(p[2]->y())) return;
  kernels::FlatTriangle& flat = flat_.emplace_back();
  for (int k = 0; k < 3; ++k) {
    flat.x[k] = p[k]->x();
    flat.y[k] = p[k]->y();
    flat.inverse_z[k] = inverse_z[k];
  }
  flat.surface = static_cast<std::uint32_t>(facets_.size() + 1);
}

void SceneCamera::AddRound(const DrawnRound& shape, const Eigen::Isometry3d& T_camera_robot) {
  const Eigen::Isometry3d T_camera_shape = T_camera_robot * shape.T_robot_shape;
  const Eigen::Isometry3d T_shape_camera = T_camera_shape.inverse();
  kernels::RoundSurface surface = {};
  kernels::RoundLook look = {};
  surface.round_ends = look.round_ends = shape.round_ends;
  surface.radius_m = shape.radius_m;
  surface.half_length_m = shape.half_length_m;
  surface.nearest_m = kNearest_m;
  look.radius_m = static_cast<float>(shape.radius_m);
  look.half_length_m = static_cast<float>(shape.half_length_m);
  look.paint = shape.paint;
  for (int k = 0; k < 3; ++k) {
    surface.origin_m[k] = T_shape_camera.translation()[k];
    for (int axis = 0; axis < 3; ++axis) surface.axes[k][axis] = T_shape_camera.linear()(k, axis);
    CopyRow(T_shape_camera.linear().row(k), look.axes[k]);
  }
  CopyRow(T_shape_camera.translation(), look.origin_m);
  round_surfaces_.push_back(surface);
  rounds_.push_back(look);
  round_bounds_.push_back(BoundsOf(shape, T_camera_shape));
}

}  // namespace palpate::virtual_camera
