// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "libs/plot/rect.hpp"

namespace palpate::plot {

/// A label that wants to stand close to a point of the figure.
struct LabelRequest {
  Eigen::Vector2d anchor_px;
  double width_px = 0.0;
  double height_px = 0.0;
};

/// Places labels one after another beside their anchors: inside `area`, clear of `taken`, of each
/// other and, as far as can be, of what is drawn (`ink_at`: 0 blank .. 1 drawn, at a pixel).
/// Returns one rectangle for each request, of the size that was asked for.
std::vector<Rect> PlaceLabels(const std::vector<LabelRequest>& requests, const Rect& area,
                              std::vector<Rect> taken,
                              const std::function<double(int x, int y)>& ink_at);

}  // namespace palpate::plot
