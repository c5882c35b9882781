// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <functional>

#include "components/view/picture/furniture.hpp"
#include "components/view/picture/overlay.hpp"
#include "components/view/picture/text.hpp"
#include "libs/plot/label_layout.hpp"

namespace palpate::view {

namespace {

struct ArrowLabel {
  const Arrow* arrow;
  plot::LabelRequest request;
};

TextStyle LabelText(const Color& color, double px) {
  return {.capital_height_px = 14.5 * px, .color = color, .bold = true, .halo_px = 3.5 * px};
}

std::vector<ArrowLabel> LabelsOf(const Scene& scene, const Camera& camera, double px) {
  std::vector<ArrowLabel> labels;
  for (const Arrow& arrow : scene.arrows) {
    if (arrow.label.empty()) {
      continue;
    }
    const double share = arrow.points_at ? -0.7 : 0.7;
    const Eigen::Vector3d anchor = camera.Project(arrow.from_m + share * arrow.vector_m);
    const TextStyle style = LabelText(arrow.color, px);
    labels.push_back(
        {&arrow,
         {anchor.head<2>(), TextWidth(arrow.label, style), style.capital_height_px + 4.0 * px}});
  }
  return labels;
}

// Keeps labels off the shaft of an arrow.
void AddShaft(const Arrow& arrow, const Camera& camera, double px, std::vector<Rect>* taken) {
  constexpr int kPieces = 16;
  for (int i = 0; i <= kPieces; ++i) {
    const double share = (arrow.points_at ? -1.0 : 1.0) * i / kPieces;
    const Eigen::Vector3d seen = camera.Project(arrow.from_m + share * arrow.vector_m);
    taken->push_back({seen.x() - 6.0 * px, seen.y() - 6.0 * px, 12.0 * px, 12.0 * px});
  }
}

// A ball behind the body shows as a ring, so that no marker seems to be missing.
void DrawHiddenBalls(const Scene& scene, double px, const Camera& camera, const Rasteriser& stage,
                     Image* image) {
  for (const Points& points : scene.points) {
    if (points.shape != Points::Shape::kBall) {
      continue;
    }
    for (Eigen::Index i = 0; i < points.points_m.cols(); ++i) {
      const Eigen::Vector3d center_m = points.points_m.col(i);
      const Eigen::Vector3d front_m =
          center_m + 1.01 * points.radius_m * camera.TowardViewer(center_m);
      const Eigen::Vector3d seen = camera.Project(center_m);
      const double in_front =
          stage.NearnessAt(static_cast<int>(seen.x()), static_cast<int>(seen.y()));
      if (in_front > camera.Project(front_m).z()) {
        DrawRing(seen.head<2>(), points.radius_m * camera.px_per_m(), 1.8 * px, points.color,
                 image);
      }
    }
  }
}

// A thin line where the label stands away from what it names.
void DrawLeader(const Eigen::Vector2d& anchor_px, const Rect& rect, double px, Image* image) {
  const Eigen::Vector2d nearest(std::clamp(anchor_px.x(), rect.x_px, rect.right_px()),
                                std::clamp(anchor_px.y(), rect.y_px, rect.bottom_px()));
  const Eigen::Vector2d away = anchor_px - nearest;
  if (away.norm() > 40.0 * px) {
    DrawStroke(nearest + 6.0 * px * away.normalized(), anchor_px, 1.2 * px, palette::kMutedInk,
               image);
  }
}

}  // namespace

void DrawAnnotations(const Scene& scene, const PageLayout& page, const Camera& camera,
                     const Rasteriser& stage, Image* image) {
  const double px = page.px;
  std::vector<Rect> taken;
  DrawHiddenBalls(scene, px, camera, stage, image);
  for (const Points& points : scene.points) {
    for (Eigen::Index i = 0; i < points.points_m.cols(); ++i) {
      const Eigen::Vector2d seen = camera.Project(points.points_m.col(i)).head<2>();
      if (points.shape == Points::Shape::kCross) {
        DrawCross(seen, 7.0 * px, 2.6 * px, points.color, image);
      }
      taken.push_back({seen.x() - 10.0 * px, seen.y() - 10.0 * px, 20.0 * px, 20.0 * px});
    }
  }
  for (const Arrow& arrow : scene.arrows) {
    AddShaft(arrow, camera, px, &taken);
  }
  const std::vector<ArrowLabel> labels = LabelsOf(scene, camera, px);
  std::vector<plot::LabelRequest> requests;
  for (const ArrowLabel& label : labels) {
    requests.push_back(label.request);
  }
  const auto ink_at = [&](int x, int y) {
    const bool inside = x >= 0 && y >= 0 && x < scene.width_px && y < scene.height_px;
    return inside ? stage.Coverage(x, y) : 0.0;
  };
  const std::vector<Rect> places = plot::PlaceLabels(requests, page.stage, taken, ink_at);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    DrawLeader(requests[i].anchor_px, places[i], px, image);
    DrawText(labels[i].arrow->label, {places[i].x_px, places[i].bottom_px() - 2.0 * px},
             LabelText(labels[i].arrow->color, px), image);
  }
}

}  // namespace palpate::view
