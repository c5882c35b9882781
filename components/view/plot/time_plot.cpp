// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/plot/time_plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "components/view/plot/series_shapes.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/plot/plot_area.hpp"
#include "libs/plot/text_width.hpp"

namespace palpate::view {

namespace {

using plot::AxisTicks;
using plot::SvgDocument;
using plot::SvgStroke;
using plot::SvgText;

constexpr double kLeft_px = 66.0;
constexpr double kRight_px = 22.0;
constexpr double kTop_px = 66.0;
constexpr double kBottom_px = 46.0;
constexpr double kBetween_px = 30.0;  // panels; holds the lower one's title
constexpr double kSmallestPanel_px = 60.0;
constexpr double kTickDistance_px = 90.0;
constexpr double kValueTickDistance_px = 38.0;
constexpr double kTitleSize_px = 15.0;
constexpr double kSmallestTitle_px = 11.0;
constexpr double kBeforeLegend_px = 16.0;
constexpr double kLineWidth_px = 1.6;
constexpr double kBandOpacity = 0.18;

void Check(const TimePlot& plot, double panel_height_px) {
  if (plot.panels.empty()) throw RunError("the plot '" + plot.title + "' has no panels");
  if (panel_height_px < kSmallestPanel_px) {
    throw RunError("a plot of " + std::to_string(plot.height_px) + " px has no room for " +
                   std::to_string(plot.panels.size()) + " panels");
  }
  for (const PlotPanel& panel : plot.panels) {
    for (const TimeSeries& series : panel.series) {
      const bool band_fits =
          series.half_widths.empty() || series.half_widths.size() == series.t_s.size();
      if (series.values.size() != series.t_s.size() || !band_fits) {
        throw RunError("the series '" + series.name + "' of the plot '" + plot.title + "' has " +
                       std::to_string(series.t_s.size()) + " times, " +
                       std::to_string(series.values.size()) + " values and " +
                       std::to_string(series.half_widths.size()) + " half-widths");
      }
    }
  }
}

// The times of all samples; a second where there are none.
AxisRange TimeRange(const TimePlot& plot) {
  AxisRange range{std::numeric_limits<double>::infinity(),
                  -std::numeric_limits<double>::infinity()};
  for (const PlotPanel& panel : plot.panels) {
    for (const TimeSeries& series : panel.series) {
      for (const double t_s : series.t_s) {
        if (!std::isfinite(t_s)) continue;
        range = {std::min(range.lower, t_s), std::max(range.upper, t_s)};
      }
    }
  }
  if (range.lower > range.upper) return {0.0, 1.0};
  if (range.lower == range.upper) return {range.lower - 0.5, range.upper + 0.5};
  return range;
}

// Names that several panels share stand there once. Returns its left edge, px.
double DrawPlotLegend(const TimePlot& plot, SvgDocument* svg) {
  std::vector<const TimeSeries*> entries;
  for (const PlotPanel& panel : plot.panels) {
    for (const TimeSeries& series : panel.series) {
      const bool listed = std::any_of(entries.begin(), entries.end(), [&](const TimeSeries* entry) {
        return entry->name == series.name;
      });
      if (!series.name.empty() && !listed) entries.push_back(&series);
    }
  }
  double right_px = plot.width_px - kRight_px;
  for (auto entry = entries.rbegin(); entry != entries.rend(); ++entry) {
    const double text_px = 6.7 * static_cast<double>((*entry)->name.size());
    const double line_px = right_px - text_px - 34.0;
    svg->Line({line_px, 20.0}, {line_px + 26.0, 20.0},
              {(*entry)->color, 2.0 * kLineWidth_px, (*entry)->dashed});
    svg->Text({line_px + 32.0, 24.0}, (*entry)->name, {});
    right_px = line_px - 18.0;
  }
  return right_px + 18.0;
}

// As large as the room in front of the legend allows.
void DrawTitle(const std::string& title, double room_px, SvgDocument* svg) {
  const double width_px = plot::TextWidth_px(title, kTitleSize_px, true);
  const double fitting_px = kTitleSize_px * std::min(1.0, room_px / std::max(1.0, width_px));
  const double size_px = std::max(kSmallestTitle_px, fitting_px);
  std::string shown = title;
  if (fitting_px < size_px) {
    const double bold =
        plot::TextWidth_px(title, size_px, true) / plot::TextWidth_px(title, size_px);
    shown = plot::Shortened(title, size_px, room_px / bold);
  }
  svg->Text({kLeft_px, 25.0}, shown, {.size_px = size_px, .bold = true});
}

void DrawPlotHeading(const TimePlot& plot, SvgDocument* svg) {
  svg->Rectangle({0.0, 0.0}, plot.width_px, plot.height_px, palette::kPaper);
  svg->Text({kLeft_px, 43.0}, plot.caption, {.size_px = 11.0, .color = palette::kMutedInk});
  DrawTitle(plot.title, DrawPlotLegend(plot, svg) - kBeforeLegend_px - kLeft_px, svg);
}

void DrawSeries(const TimeSeries& series, const PlotArea& area, SvgDocument* svg) {
  for (const std::vector<SvgPoint>& outline : BandOutlines(series, area)) {
    svg->Polygon(outline, series.color, kBandOpacity);
  }
  for (const std::vector<SvgPoint>& stretch : Stretches(series, area)) {
    if (stretch.size() == 1) {
      svg->Dot(stretch.front(), kLineWidth_px, series.color);
    } else {
      svg->Polyline(stretch, {series.color, kLineWidth_px, series.dashed});
    }
  }
}

void DrawPanel(const PlotPanel& panel, const PlotArea& area, const AxisTicks& times, bool is_lowest,
               SvgDocument* svg) {
  const AxisTicks values =
      plot::MakeTicks(area.y(), static_cast<int>(area.height_px() / kValueTickDistance_px));
  plot::DrawAxes(area, times, values, is_lowest, svg);
  svg->Text({area.left_px(), area.top_px() - 6.0}, panel.title, {.size_px = 12.0, .bold = true});
  svg->Text({18.0, 0.5 * (area.top_px() + area.bottom_px())}, panel.value_title,
            {.anchor = SvgText::Anchor::kMiddle, .turned_deg = 90.0});
  svg->BeginGroup("panel", {area.left_px(), area.top_px()}, area.right_px() - area.left_px(),
                  area.height_px());
  for (const TimeSeries& series : panel.series) DrawSeries(series, area, svg);
  svg->EndGroup();
}

}  // namespace

std::string DrawTimePlot(const TimePlot& plot) {
  const auto count = static_cast<double>(plot.panels.size());
  const double height_px =
      (plot.height_px - kTop_px - kBottom_px - (count - 1.0) * kBetween_px) / std::max(count, 1.0);
  Check(plot, height_px);
  SvgDocument svg(plot.width_px, plot.height_px);
  DrawPlotHeading(plot, &svg);
  const AxisRange time_s = TimeRange(plot);
  const double width_px = plot.width_px - kLeft_px - kRight_px;
  const AxisTicks times = plot::MakeTicks(time_s, static_cast<int>(width_px / kTickDistance_px));
  double top_px = kTop_px;
  for (const PlotPanel& panel : plot.panels) {
    const int marks = static_cast<int>(height_px / kValueTickDistance_px);
    const PlotArea area({kLeft_px, top_px}, width_px, height_px, time_s,
                        plot::RoundOutward(ValueRange(panel), marks));
    DrawPanel(panel, area, times, &panel == &plot.panels.back(), &svg);
    top_px += height_px + kBetween_px;
  }
  svg.Text({kLeft_px + 0.5 * width_px, plot.height_px - 12.0}, plot.time_title,
           {.anchor = SvgText::Anchor::kMiddle});
  return svg.Finish();
}

void SaveTimePlot(const std::filesystem::path& file, const TimePlot& plot) {
  WriteFile(file, DrawTimePlot(plot));
}

}  // namespace palpate::view
