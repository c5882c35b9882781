// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/plot/plot_area.hpp"

namespace palpate::plot {

void DrawAxes(const PlotArea& area, const AxisTicks& x, const AxisTicks& y, bool x_labels,
              SvgDocument* svg) {
  const SvgStroke rule{palette::kGridLine, 1.0, false};
  SvgText text{.size_px = 11.0, .color = palette::kMutedInk};
  for (std::size_t i = 0; i < y.values.size(); ++i) {
    const double y_px = area.Y_px(y.values[i]);
    svg->Line({area.left_px(), y_px}, {area.right_px(), y_px}, rule);
    text.anchor = SvgText::Anchor::kEnd;
    svg->Text({area.left_px() - 7.0, y_px + 4.0}, y.labels[i], text);
  }
  for (std::size_t i = 0; i < x.values.size(); ++i) {
    const double x_px = area.X_px(x.values[i]);
    svg->Line({x_px, area.top_px()}, {x_px, area.bottom_px()}, rule);
    text.anchor = SvgText::Anchor::kMiddle;
    if (x_labels) svg->Text({x_px, area.bottom_px() + 16.0}, x.labels[i], text);
  }
  const SvgStroke axis{palette::kMutedInk, 1.0, false};
  svg->Line({area.left_px(), area.bottom_px()}, {area.right_px(), area.bottom_px()}, axis);
  svg->Line({area.left_px(), area.top_px()}, {area.left_px(), area.bottom_px()}, axis);
}

}  // namespace palpate::plot
