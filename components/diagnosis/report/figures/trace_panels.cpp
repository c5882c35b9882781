// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/report/figures/trace_panels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libs/plot/plot_area.hpp"
#include "libs/plot/text_width.hpp"

namespace palpate::diagnosis {

namespace {

using plot::PlotArea;
using plot::SvgPoint;
using plot::SvgText;

constexpr double kLegend_px = 30.0, kTitle_px = 40.0, kPanel_px = 170.0, kAxis_px = 48.0;
constexpr double kLeft_px = 58.0, kGap_px = 66.0, kRight_px = 12.0;
/// Arrow heads on a line, and how far one must have come to draw it.
constexpr int kHeads = 4;
constexpr double kHead_px = 8.0;

/// One for all panels, so that they can be compared.
plot::AxisRange ValueRange(const std::vector<TracePanel>& panels, bool show_after) {
  plot::AxisRange range{0.0, 0.0};
  const auto hold = [&](const std::vector<double>& values) {
    for (const double value : values) {
      if (!std::isfinite(value)) continue;
      range = {std::min(range.lower, value), std::max(range.upper, value)};
    }
  };
  for (const TracePanel& panel : panels) {
    hold(panel.before_mm);
    if (show_after) hold(panel.after_mm);
  }
  return plot::RoundOutward(range, 4);
}

void DrawHeads(const std::vector<SvgPoint>& line, const plot::Color& color,
               plot::SvgDocument* svg) {
  double whole_px = 0.0;
  std::vector<double> way_px = {0.0};
  for (std::size_t i = 1; i < line.size(); ++i) {
    whole_px += std::hypot(line[i].x_px - line[i - 1].x_px, line[i].y_px - line[i - 1].y_px);
    way_px.push_back(whole_px);
  }
  if (whole_px < 2.0 * kHeads * kHead_px) return;
  for (int head = 0; head < kHeads; ++head) {
    const double at_px = whole_px * (head + 0.5) / kHeads;
    const auto after = std::upper_bound(way_px.begin(), way_px.end(), at_px);
    const auto i = static_cast<std::size_t>(after - way_px.begin());
    if (i == 0 || i >= line.size()) continue;
    const SvgPoint& from = line[i - 1];
    const double step_px = way_px[i] - way_px[i - 1];
    const double x = (line[i].x_px - from.x_px) / step_px;
    const double y = (line[i].y_px - from.y_px) / step_px;
    const double past_px = at_px - way_px[i - 1];
    const SvgPoint tip{from.x_px + x * past_px, from.y_px + y * past_px};
    svg->Arrow({tip.x_px - kHead_px * x, tip.y_px - kHead_px * y}, tip, kHead_px, {color, 1.0});
  }
}

void DrawTrace(const TracePanel& panel, const std::vector<double>& values_mm,
               const plot::Color& color, const PlotArea& area, plot::SvgDocument* svg) {
  std::vector<SvgPoint> line;
  for (std::size_t i = 0; i < panel.x.size(); ++i) {
    if (!std::isfinite(panel.x[i]) || !std::isfinite(values_mm[i])) continue;
    line.push_back(area.Place(panel.x[i], values_mm[i]));
  }
  if (line.size() >= 2) svg->Polyline(line, {color, 1.6});
  for (const SvgPoint& point : line) svg->Dot(point, 1.9, color);
  if (panel.directed) DrawHeads(line, color, svg);
}

void DrawPanel(const TracePanel& panel, bool show_after, const plot::AxisRange& range,
               const SvgPoint& corner, double width_px, plot::SvgDocument* svg) {
  const PlotArea area(corner, width_px, kPanel_px, panel.x_range, range);
  plot::DrawAxes(area, panel.x_ticks, plot::MakeTicks(range, 4), true, svg);
  if (range.lower < 0.0 && range.upper > 0.0) {
    svg->Line(area.Place(panel.x_range.lower, 0.0), area.Place(panel.x_range.upper, 0.0),
              {plot::palette::kMutedInk, 1.0, true});
  }
  svg->Text({corner.x_px, corner.y_px - 23.0}, plot::Shortened(panel.title, 13.0, width_px),
            {.size_px = kLabelSize_px, .bold = true});
  svg->Text({corner.x_px, corner.y_px - 8.0}, plot::Shortened(panel.note, 11.0, width_px),
            {.size_px = 11.0, .color = plot::palette::kMutedInk});
  svg->Text({corner.x_px + 0.5 * width_px, area.bottom_px() + 35.0}, panel.x_title,
            {.anchor = SvgText::Anchor::kMiddle, .size_px = kLabelSize_px});
  svg->Text({corner.x_px - 44.0, corner.y_px + 0.5 * kPanel_px}, "residual (mm)",
            {.anchor = SvgText::Anchor::kMiddle, .size_px = kLabelSize_px, .turned_deg = 90.0});
  svg->BeginGroup("panel", corner, width_px, kPanel_px);
  DrawTrace(panel, panel.before_mm, ink::kBefore, area, svg);
  if (show_after) DrawTrace(panel, panel.after_mm, ink::kAfter, area, svg);
  svg->EndGroup();
}

}  // namespace

std::string DrawTracePanels(const std::string& id, const std::vector<TracePanel>& panels,
                            bool show_after) {
  const std::size_t rows = (panels.size() + 1) / 2;
  const double row_px = kTitle_px + kPanel_px + kAxis_px;
  plot::SvgDocument svg(kFigureWidth_px,
                        static_cast<int>(kLegend_px + row_px * static_cast<double>(rows)), id);
  std::vector<LegendEntry> legend = {{"before", ink::kBefore, LegendEntry::Mark::kLine}};
  if (show_after) legend.push_back({"after", ink::kAfter, LegendEntry::Mark::kLine});
  DrawLegend(legend, {kLeft_px, 18.0}, kFigureWidth_px - kLeft_px, &svg);
  const double half_px = 0.5 * (kFigureWidth_px - kLeft_px - kGap_px - kRight_px);
  const double width_px = panels.size() == 1 ? kFigureWidth_px - kLeft_px - kRight_px : half_px;
  const plot::AxisRange range = ValueRange(panels, show_after);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const SvgPoint corner{kLeft_px + static_cast<double>(i % 2) * (half_px + kGap_px),
                          kLegend_px + kTitle_px + static_cast<double>(i / 2) * row_px};
    DrawPanel(panels[i], show_after, range, corner, width_px, &svg);
  }
  return svg.Element();
}

}  // namespace palpate::diagnosis
