// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/plot/axis_ticks.hpp"
#include "libs/plot/svg_document.hpp"

namespace palpate::plot {

/// Where the axes of a panel lie in the figure.
class PlotArea {
 public:
  PlotArea(const SvgPoint& corner, double width_px, double height_px, const AxisRange& x,
           const AxisRange& y)
      : corner_(corner), width_px_(width_px), height_px_(height_px), x_(x), y_(y) {}

  double left_px() const { return corner_.x_px; }
  double right_px() const { return corner_.x_px + width_px_; }
  double top_px() const { return corner_.y_px; }
  double bottom_px() const { return corner_.y_px + height_px_; }
  double width_px() const { return width_px_; }
  double height_px() const { return height_px_; }
  const AxisRange& x() const { return x_; }
  const AxisRange& y() const { return y_; }

  double X_px(double x) const {
    return left_px() + width_px_ * (x - x_.lower) / (x_.upper - x_.lower);
  }
  double Y_px(double y) const {
    return bottom_px() - height_px_ * (y - y_.lower) / (y_.upper - y_.lower);
  }
  SvgPoint Place(double x, double y) const { return {X_px(x), Y_px(y)}; }

 private:
  SvgPoint corner_;
  double width_px_;
  double height_px_;
  AxisRange x_;
  AxisRange y_;
};

/// Grid lines at the marks, the two axes and the texts of the marks; those of x only where
/// `x_labels`.
void DrawAxes(const PlotArea& area, const AxisTicks& x, const AxisTicks& y, bool x_labels,
              SvgDocument* svg);

}  // namespace palpate::plot
