// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

namespace palpate::plot {

/// A rectangle of the figure, x to the right, y down, px.
struct Rect {
  double x_px = 0.0;
  double y_px = 0.0;
  double width_px = 0.0;
  double height_px = 0.0;

  double right_px() const { return x_px + width_px; }
  double bottom_px() const { return y_px + height_px; }
  bool Overlaps(const Rect& other) const {
    return x_px < other.right_px() && other.x_px < right_px() && y_px < other.bottom_px() &&
           other.y_px < bottom_px();
  }
  bool Contains(const Rect& other) const {
    return other.x_px >= x_px && other.right_px() <= right_px() && other.y_px >= y_px &&
           other.bottom_px() <= bottom_px();
  }
};

}  // namespace palpate::plot
