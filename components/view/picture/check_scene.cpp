// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/picture/check_scene.hpp"

#include <cmath>

#include "libs/core/error.hpp"
#include "libs/core/index.hpp"

namespace palpate::view {

namespace {

[[noreturn]] void Refuse(const std::string& what) {
  throw RunError("cannot draw the scene: " + what);
}

void CheckPoints(const Eigen::Matrix3Xd& points_m, const std::string& part) {
  for (Eigen::Index i = 0; i < points_m.cols(); ++i) {
    if (!points_m.col(i).allFinite()) {
      Refuse("point " + std::to_string(i) + " of " + part + " is not finite");
    }
  }
}

void CheckSurface(const Surface& surface, const std::string& part) {
  CheckPoints(surface.points_m, part);
  const Eigen::Index count = surface.points_m.cols();
  for (Eigen::Index t = 0; t < surface.triangles.cols(); ++t) {
    const Eigen::Vector3i corners = surface.triangles.col(t);
    if (corners.minCoeff() < 0 || corners.maxCoeff() >= count) {
      Refuse("triangle " + std::to_string(t) + " of " + part +
             " names a point that is not there (" + std::to_string(count) + " points)");
    }
  }
  if (surface.scalars.size() != 0 && surface.scalars.size() != count) {
    Refuse(part + " has " + std::to_string(surface.scalars.size()) + " scalars for " +
           std::to_string(count) + " points");
  }
  if (!surface.scalars.allFinite()) {
    Refuse("a scalar of " + part + " is not finite");
  }
}

void CheckSize(const Scene& scene) {
  constexpr int kLargest_px = 8192;
  if (scene.width_px < 320 || scene.height_px < 240 || scene.width_px > kLargest_px ||
      scene.height_px > kLargest_px || scene.samples_per_px < 1 || scene.samples_per_px > 8) {
    Refuse("an image of " + std::to_string(scene.width_px) + " x " +
           std::to_string(scene.height_px) + " px with " + std::to_string(scene.samples_per_px) +
           " samples a pixel (320 x 240 to 8192 x 8192, 1 to 8)");
  }
  if (!(std::abs(scene.view.elevation_deg) < 90.0) || !std::isfinite(scene.view.azimuth_deg)) {
    Refuse("the view needs an elevation between -90 and 90 degrees and a finite azimuth");
  }
}

void CheckNotEmpty(const Scene& scene) {
  Eigen::Index things = ToIndex(scene.arrows.size() + scene.blocks.size());
  for (const Surface& surface : scene.surfaces) {
    things += surface.triangles.cols();
  }
  for (const Surface& ghost : scene.ghosts) {
    things += ghost.triangles.cols();
  }
  for (const Tube& tube : scene.tubes) {
    things += tube.points_m.cols();
  }
  for (const Points& points : scene.points) {
    things += points.points_m.cols();
  }
  if (things == 0) {
    Refuse("there is nothing in it");
  }
}

}  // namespace

void CheckScene(const Scene& scene) {
  CheckSize(scene);
  CheckNotEmpty(scene);
  for (const Surface& surface : scene.surfaces) {
    CheckSurface(surface, "a surface");
  }
  for (const Surface& ghost : scene.ghosts) {
    CheckSurface(ghost, "a ghost");
  }
  for (const Tube& tube : scene.tubes) {
    CheckPoints(tube.points_m, "a tube");
  }
  for (const Points& points : scene.points) {
    CheckPoints(points.points_m, points.name.empty() ? "the points" : "'" + points.name + "'");
  }
  for (const Arrow& arrow : scene.arrows) {
    if (!arrow.from_m.allFinite() || !arrow.vector_m.allFinite()) {
      Refuse("arrow '" + arrow.label + "' is not finite");
    }
  }
  for (const Block& block : scene.blocks) {
    if (!block.center_m.allFinite() || !block.half_axes_m.allFinite()) {
      Refuse("a block is not finite");
    }
  }
  if (scene.floor_z_m && !std::isfinite(*scene.floor_z_m)) {
    Refuse("the floor's height is not finite");
  }
  if (scene.color_bar &&
      !(scene.color_bar->maximum > 0.0 &&
        std::isfinite(scene.color_bar->maximum * scene.color_bar->shown_per_unit))) {
    Refuse("the colour bar '" + scene.color_bar->title + "' needs a maximum above 0");
  }
}

}  // namespace palpate::view
