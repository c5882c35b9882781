// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/picture/stage.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "components/view/picture/shapes.hpp"
#include "components/view/picture/surface_edges.hpp"
#include "libs/core/index.hpp"

namespace palpate::view {

namespace {

void AddPoints(const Eigen::Matrix3Xd& points_m, double radius_m, std::vector<Extent>* extents) {
  for (Eigen::Index i = 0; i < points_m.cols(); ++i) {
    extents->push_back({points_m.col(i), radius_m});
  }
}

constexpr double kInFront_m = 100.0;  // no scene is as large

struct FloorArea {
  Eigen::Array2d lower_m;
  Eigen::Array2d upper_m;
  double step_m;
};

// The part of the floor under the scene, in whole steps of the grid.
FloorArea FloorUnder(const std::vector<Extent>& extents) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Eigen::Array2d lower = Eigen::Array2d::Constant(kInfinity);
  Eigen::Array2d upper = Eigen::Array2d::Constant(-kInfinity);
  for (const Extent& extent : extents) {
    lower = lower.min(extent.center_m.head<2>().array() - extent.radius_m);
    upper = upper.max(extent.center_m.head<2>().array() + extent.radius_m);
  }
  const double step_m = RoundStepBelow(std::max((upper - lower).maxCoeff(), 1e-6) / 5.0);
  return {((lower / step_m).floor() * step_m), ((upper / step_m).ceil() * step_m), step_m};
}

std::vector<Extent> ExtentsWithoutFloor(const Scene& scene) {
  std::vector<Extent> extents;
  for (const Surface& surface : scene.surfaces) {
    AddPoints(surface.points_m, 0.0, &extents);
  }
  for (const Surface& ghost : scene.ghosts) {
    AddPoints(ghost.points_m, 0.0, &extents);
  }
  for (const Tube& tube : scene.tubes) {
    AddPoints(tube.points_m, tube.radius_m, &extents);
  }
  for (const Points& points : scene.points) {
    const bool balls = points.shape == Points::Shape::kBall;
    AddPoints(points.points_m, balls ? points.radius_m : 0.0, &extents);
  }
  for (const Arrow& arrow : scene.arrows) {
    extents.push_back({arrow.from_m, 0.0});
    extents.push_back({arrow.from_m + (arrow.points_at ? -1.0 : 1.0) * arrow.vector_m, 0.0});
  }
  for (const Block& block : scene.blocks) {
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d signs(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      extents.push_back({block.center_m + block.half_axes_m * signs, 0.0});
    }
  }
  return extents;
}

// Draws with one camera and one set of lamps.
class Stage {
 public:
  Stage(const Camera& camera, double px, Rasteriser* rasteriser)
      : camera_(camera), px_(px), rasteriser_(rasteriser) {
    const Eigen::Vector3d right = camera.right();
    const Eigen::Vector3d up = camera.up();
    const Eigen::Vector3d toward = right.cross(up);
    lighting_.key = (-0.45 * right + 0.80 * up + 0.55 * toward).normalized();
    lighting_.fill = (0.85 * right + 0.10 * up + 0.50 * toward).normalized();
    lighting_.toward_viewer = toward;
  }

  double Metres(double pixels) const { return pixels * px_ / camera_.px_per_m(); }

  void Draw(const ShadedTriangles& shape, Rasteriser* target, double lift_m = 0.0) const {
    for (std::size_t i = 0; i + 2 < shape.corners.size(); i += 3) {
      std::array<Vertex, 3> vertices;
      for (std::size_t k = 0; k < 3; ++k) {
        const ShadedTriangles::Corner& corner = shape.corners[i + k];
        vertices[k] = {camera_.Project(corner.point_m), corner.normal, corner.color};
        vertices[k].seen.z() += lift_m;
      }
      target->DrawTriangle(vertices, lighting_);
    }
  }

  void Draw(const ShadedTriangles& shape) const { Draw(shape, rasteriser_); }

  // Lifted towards the viewer, so that a line on a surface is not swallowed by it.
  void DrawLine(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m, double width,
                const Color& color, double opacity, double lift = 1.6) const {
    const Eigen::Vector3d offset_from = Metres(lift) * camera_.TowardViewer(from_m);
    const Eigen::Vector3d offset_to = Metres(lift) * camera_.TowardViewer(to_m);
    Eigen::Vector3d from = camera_.Project(from_m);
    Eigen::Vector3d to = camera_.Project(to_m);
    from.z() = camera_.Project(from_m + offset_from).z();
    to.z() = camera_.Project(to_m + offset_to).z();
    rasteriser_->DrawLine(from, to, width * px_, color, opacity);
  }

  void DrawEdges(const Eigen::Matrix3Xd& points_m, const Eigen::Matrix2Xi& edges, double width,
                 const Color& color, double opacity) const {
    for (Eigen::Index i = 0; i < edges.cols(); ++i) {
      DrawLine(points_m.col(edges(0, i)), points_m.col(edges(1, i)), width, color, opacity);
    }
  }

  void DrawSurface(const Surface& surface, double scalar_maximum) const;
  void DrawGhosts(const Scene& scene) const;
  void DrawFloor(const Scene& scene, double floor_z_m) const;
  void DrawBlock(const Block& block) const;
  void DrawTube(const Tube& tube) const;
  void DrawArrow(const Arrow& arrow) const;

 private:
  const Camera& camera_;
  double px_;
  Rasteriser* rasteriser_;
  Lighting lighting_;
};

void Stage::DrawSurface(const Surface& surface, double scalar_maximum) const {
  const SurfaceEdges edges = FindEdges(surface.points_m, surface.triangles, camera_);
  ShadedTriangles shape;
  for (Eigen::Index t = 0; t < surface.triangles.cols(); ++t) {
    std::array<ShadedTriangles::Corner, 3> corners;
    for (int i = 0; i < 3; ++i) {
      const int point = surface.triangles(i, t);
      const Color color = surface.scalars.size() == 0
                              ? surface.color
                              : SequentialColor(surface.scalars(point) / scalar_maximum);
      corners[At(i)] = {surface.points_m.col(point), edges.corner_normals.col(3 * t + i), color};
    }
    shape.AddTriangle(corners[0], corners[1], corners[2]);
  }
  Draw(shape);
  if (surface.show_triangle_edges) {
    DrawEdges(surface.points_m, edges.all, 0.9, palette::kInk, 0.16);
  }
  DrawEdges(surface.points_m, edges.outlines, 1.5, palette::kInk, 0.75);
}

void Stage::DrawGhosts(const Scene& scene) const {
  if (scene.ghosts.empty()) {
    return;
  }
  Rasteriser veil(scene.width_px, scene.height_px, scene.samples_per_px, palette::kPaper);
  for (const Surface& ghost : scene.ghosts) {
    ShadedTriangles shape;
    for (Eigen::Index t = 0; t < ghost.triangles.cols(); ++t) {
      for (int i = 0; i < 3; ++i) {
        shape.corners.push_back(
            {ghost.points_m.col(ghost.triangles(i, t)), Eigen::Vector3d::Zero(), palette::kGhost});
      }
    }
    Draw(shape, &veil);
  }
  // Sides that have hardly moved would flicker between body and ghost without a margin.
  rasteriser_->Overlay(veil, 0.12, Metres(8.0));
  for (const Surface& ghost : scene.ghosts) {
    const SurfaceEdges edges = FindEdges(ghost.points_m, ghost.triangles, camera_);
    DrawEdges(ghost.points_m, edges.outlines, 1.2, palette::kGhost, 1.0);
  }
}

void Stage::DrawFloor(const Scene& scene, double floor_z_m) const {
  ShadedTriangles shadow;
  for (const Surface& surface : scene.surfaces) {
    for (Eigen::Index i = 0; i < surface.triangles.size(); ++i) {
      Eigen::Vector3d point = surface.points_m.col(surface.triangles(i % 3, i / 3));
      point.z() = floor_z_m;
      shadow.corners.push_back({point, Eigen::Vector3d::Zero(), palette::kShadow});
    }
  }
  Draw(shadow);
  const FloorArea area = FloorUnder(ExtentsWithoutFloor(scene));
  const auto line = [&](double x0, double y0, double x1, double y1) {
    DrawLine({x0, y0, floor_z_m}, {x1, y1, floor_z_m}, 1.1, palette::kFloorLine, 1.0, 0.4);
  };
  const Eigen::Array2i steps = ((area.upper_m - area.lower_m) / area.step_m + 0.5).cast<int>();
  for (int i = 0; i <= steps.x(); ++i) {
    const double x = area.lower_m.x() + i * area.step_m;
    line(x, area.lower_m.y(), x, area.upper_m.y());
  }
  for (int i = 0; i <= steps.y(); ++i) {
    const double y = area.lower_m.y() + i * area.step_m;
    line(area.lower_m.x(), y, area.upper_m.x(), y);
  }
}

void Stage::DrawBlock(const Block& block) const {
  ShadedTriangles shape;
  AddBox(block.center_m, block.half_axes_m, block.color, &shape);
  Draw(shape);
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 4; ++side) {
      Eigen::Vector3d signs;
      signs(axis) = -1.0;
      signs((axis + 1) % 3) = side & 1 ? 1.0 : -1.0;
      signs((axis + 2) % 3) = side & 2 ? 1.0 : -1.0;
      Eigen::Vector3d end_signs = signs;
      end_signs(axis) = 1.0;
      DrawLine(block.center_m + block.half_axes_m * signs,
               block.center_m + block.half_axes_m * end_signs, 1.2, palette::kMutedInk, 1.0);
    }
  }
}

void Stage::DrawTube(const Tube& tube) const {
  ShadedTriangles shape;
  const double radius_m = std::max(tube.radius_m, Metres(1.4));
  for (Eigen::Index i = 0; i < tube.points_m.cols(); ++i) {
    AddBall(tube.points_m.col(i), 1.02 * radius_m, tube.color, &shape);
    if (i > 0) {
      AddFrustum(tube.points_m.col(i - 1), radius_m, tube.points_m.col(i), radius_m, tube.color,
                 &shape);
    }
  }
  Draw(shape);
}

void Stage::DrawArrow(const Arrow& arrow) const {
  const double length_m = arrow.vector_m.norm();
  if (length_m == 0.0) {
    return;
  }
  const Eigen::Vector3d direction = arrow.vector_m / length_m;
  const Eigen::Vector3d tail = arrow.points_at ? arrow.from_m - arrow.vector_m : arrow.from_m;
  const double head_m = std::min(Metres(30.0), 0.5 * length_m);
  const double width = head_m / Metres(30.0);
  const Eigen::Vector3d neck = tail + (length_m - head_m) * direction;
  ShadedTriangles shape;
  AddDisc(tail, direction, width * Metres(4.2), arrow.color, &shape);
  AddFrustum(tail, width * Metres(4.2), neck, width * Metres(4.2), arrow.color, &shape);
  AddDisc(neck, direction, width * Metres(11.0), arrow.color, &shape);
  AddFrustum(neck, width * Metres(11.0), tail + arrow.vector_m, 0.0, arrow.color, &shape);
  // In front of everything: a force that runs through the body must be seen whole.
  Draw(shape, rasteriser_, kInFront_m);
}

}  // namespace

double RoundStepBelow(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value) + 1e-9));
  const double leading = value / power + 1e-9;
  return power * (leading >= 5.0 ? 5.0 : leading >= 2.0 ? 2.0 : 1.0);
}

std::vector<Extent> ExtentsOf(const Scene& scene) {
  std::vector<Extent> extents = ExtentsWithoutFloor(scene);
  if (scene.floor_z_m) {
    const FloorArea area = FloorUnder(extents);
    for (const double x : {area.lower_m.x(), area.upper_m.x()}) {
      for (const double y : {area.lower_m.y(), area.upper_m.y()}) {
        extents.push_back({{x, y, *scene.floor_z_m}, 0.0});
      }
    }
  }
  return extents;
}

void DrawStage(const Scene& scene, const Camera& camera, double px, Rasteriser* rasteriser) {
  const Stage stage(camera, px, rasteriser);
  if (scene.floor_z_m) {
    stage.DrawFloor(scene, *scene.floor_z_m);
  }
  for (const Block& block : scene.blocks) {
    stage.DrawBlock(block);
  }
  for (const Surface& surface : scene.surfaces) {
    stage.DrawSurface(surface, scene.color_bar ? scene.color_bar->maximum : 1.0);
  }
  stage.DrawGhosts(scene);
  for (const Tube& tube : scene.tubes) {
    stage.DrawTube(tube);
  }
  for (const Points& points : scene.points) {
    ShadedTriangles shape;
    if (points.shape == Points::Shape::kBall) {
      for (Eigen::Index i = 0; i < points.points_m.cols(); ++i) {
        AddBall(points.points_m.col(i), points.radius_m, points.color, &shape);
      }
    }
    stage.Draw(shape);
  }
  for (const Arrow& arrow : scene.arrows) {
    stage.DrawArrow(arrow);
  }
}

}  // namespace palpate::view
