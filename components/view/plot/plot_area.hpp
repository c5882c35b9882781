// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/view/plot/axis_ticks.hpp"
#include "components/view/plot/svg_document.hpp"
#include "components/view/plot/time_plot.hpp"

namespace palpate::view {

/// Where the axes of a panel lie in the picture.
class PlotArea {
 public:
  PlotArea(const SvgPoint& corner, double width_px, double height_px, const AxisRange& time_s,
           const AxisRange& values)
      : corner_(corner),
        width_px_(width_px),
        height_px_(height_px),
        time_s_(time_s),
        values_(values) {}

  double left_px() const { return corner_.x_px; }
  double right_px() const { return corner_.x_px + width_px_; }
  double top_px() const { return corner_.y_px; }
  double bottom_px() const { return corner_.y_px + height_px_; }
  double height_px() const { return height_px_; }
  const AxisRange& values() const { return values_; }

  double X_px(double t_s) const {
    return left_px() + width_px_ * (t_s - time_s_.lower) / (time_s_.upper - time_s_.lower);
  }
  double Y_px(double value) const {
    return bottom_px() - height_px_ * (value - values_.lower) / (values_.upper - values_.lower);
  }
  SvgPoint Place(double t_s, double value) const { return {X_px(t_s), Y_px(value)}; }

 private:
  SvgPoint corner_;
  double width_px_;
  double height_px_;
  AxisRange time_s_;
  AxisRange values_;
};

/// What the value axis of a panel has to hold: the values, and the bands as far as they do not
/// dwarf them. From 0 to 1 where there are no values.
AxisRange ValueRange(const PlotPanel& panel);

/// The stretches of a line between its gaps.
std::vector<std::vector<SvgPoint>> Stretches(const TimeSeries& series, const PlotArea& area);

/// The outlines of the band, one for each stretch that has one.
std::vector<std::vector<SvgPoint>> BandOutlines(const TimeSeries& series, const PlotArea& area);

}  // namespace palpate::view
