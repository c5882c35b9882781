// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/plot/label_layout.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace palpate::plot {

namespace {

constexpr int kDirections = 16;
constexpr int kRings = 10;
constexpr double kMargin_px = 6.0;

// Share of the label's ground that is drawn on, from a coarse grid of pixels.
double InkUnder(const Rect& rect, const std::function<double(int, int)>& ink_at) {
  constexpr int kStep_px = 4;
  double ink = 0.0;
  int pixels = 0;
  for (double y = rect.y_px; y < rect.bottom_px(); y += kStep_px) {
    for (double x = rect.x_px; x < rect.right_px(); x += kStep_px) {
      ink += ink_at(static_cast<int>(x), static_cast<int>(y));
      ++pixels;
    }
  }
  return pixels == 0 ? 0.0 : ink / pixels;
}

Rect Grown(const Rect& rect) {
  return {rect.x_px - kMargin_px, rect.y_px - kMargin_px, rect.width_px + 2.0 * kMargin_px,
          rect.height_px + 2.0 * kMargin_px};
}

Rect Candidate(const LabelRequest& request, int ring, int direction) {
  const double angle = 2.0 * std::numbers::pi * direction / kDirections;
  const double gap_px = 10.0 + 14.0 * ring;
  const Eigen::Vector2d out(std::cos(angle), std::sin(angle));
  const Eigen::Vector2d center =
      request.anchor_px + Eigen::Vector2d(out.x() * (gap_px + 0.5 * request.width_px),
                                          out.y() * (gap_px + 0.5 * request.height_px));
  return {center.x() - 0.5 * request.width_px, center.y() - 0.5 * request.height_px,
          request.width_px, request.height_px};
}

Rect Best(const LabelRequest& request, const Rect& area, const std::vector<Rect>& taken,
          const std::function<double(int, int)>& ink_at) {
  Rect best = Candidate(request, 0, 0);
  double best_cost = std::numeric_limits<double>::infinity();
  for (int ring = 0; ring < kRings; ++ring) {
    for (int direction = 0; direction < kDirections; ++direction) {
      const Rect rect = Candidate(request, ring, direction);
      double cost = 0.25 * ring + 0.01 * direction;
      if (area.Contains(rect)) {
        cost += 8.0 * InkUnder(Grown(rect), ink_at);
      } else {
        cost += 1000.0;
      }
      for (const Rect& other : taken) {
        cost += Grown(rect).Overlaps(other) ? 100.0 : 0.0;
      }
      if (cost < best_cost) {
        best_cost = cost;
        best = rect;
      }
    }
  }
  return best;
}

}  // namespace

std::vector<Rect> PlaceLabels(const std::vector<LabelRequest>& requests, const Rect& area,
                              std::vector<Rect> taken,
                              const std::function<double(int x, int y)>& ink_at) {
  std::vector<Rect> placed;
  for (const LabelRequest& request : requests) {
    placed.push_back(Best(request, area, taken, ink_at));
    taken.push_back(placed.back());
  }
  return placed;
}

}  // namespace palpate::plot
